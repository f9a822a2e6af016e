// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/takagi_sugeno.h"

namespace beamgyro::internal {

/// Table [fuzzy].
struct FuzzySpec {
  int rules = 8;  // >= 2

  static constexpr const char* kName = "fuzzy";
  static constexpr InputRule kInputRule = InputRule::kTemperatureFirst;
  static constexpr bool kIsCandidate = true;
  using Function = TakagiSugeno;
  static FuzzySpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
