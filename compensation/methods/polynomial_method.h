// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/polynomial.h"

namespace beamgyro::internal {

/// Table [polynomial].
struct PolynomialSpec {
  int degree = 3;  // 0 ... 12
  // false: powers of T - 25 degC in kelvins by the normal equations
  bool normalised = true;

  static constexpr const char* kName = "polynomial";
  static constexpr InputRule kInputRule = InputRule::kTemperatureFirst;
  using Function = Polynomial;
  static PolynomialSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
