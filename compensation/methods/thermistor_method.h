// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/methods/method.h"
#include "compensation/models/thermistor_network.h"

namespace beamgyro::internal {

/// Table [thermistor].
struct ThermistorSpec {
  double b_K = 3950.0;  // [K], > 0

  static constexpr const char* kName = "thermistor";
  static constexpr InputRule kInputRule = InputRule::kOneTemperature;
  static constexpr bool kIsCandidate = true;
  using Function = ThermistorNetwork;
  static ThermistorSpec read(MethodSource& source);
  std::string method_name() const;
  Fit fit(const FitTask& task) const;
};

}  // namespace beamgyro::internal
