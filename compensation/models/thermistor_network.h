// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/models/bias_function.h"

namespace beamgyro::internal {

/// Compensation by hardware: an NTC and three resistors divide a reference
/// voltage, and the divided voltage is added to the output,
///
///   n(T)  = exp(B (1 / T - 1 / 298.15 K)),   the NTC over its value at 25 degC
///   p     = n r_p / (n + r_p),               with a resistor beside it
///   b(T)  = offset + gain r_d / (r_d + r_s + p)   [deg/s]
///
/// with all resistances divided by that of the NTC at 25 degC. The shape
/// depends on the resistances through one number only, the position n' of the
/// bend:
///
///   b(T) = b_0 + b_1 / (1 + n / n'),   1 / n' = 1 / (r_s + r_d) + 1 / r_p
struct ThermistorNetwork {
  double b_K = 3950.0;    // [K], > 0, of the NTC
  double series = 1.0;    // r_s > 0
  double parallel = 1.0;  // r_p > 0
  double divider = 1.0;   // r_d > 0
  double offset = 0.0;    // [deg/s]
  double gain = 0.0;      // [deg/s]

  /// Returns b(T) [deg/s] at the temperatures x [degC].
  Eigen::ArrayXd predict(const Eigen::Ref<const Eigen::ArrayXd>& x) const;

  static constexpr const char* kKind = "thermistor";
  static constexpr InputUse kInputUse = InputUse::kOne;
  nlohmann::ordered_json parameters() const;
  static ThermistorNetwork read(const JsonNode& node, std::size_t inputs);
  void put_arrays(FirmwareArrays& arrays) const;
  float firmware_value(const FirmwareArrays& arrays,
                       std::span<const float> x) const;
  FirmwareCode firmware_code(std::size_t inputs) const;
};

constexpr double kLeastBend = 1e-3, kLargestBend = 1e3;  // n' of a fit [-]

/// Fits b_0, b_1 and kLeastBend <= n' <= kLargestBend by least squares. Returns
/// them as the network with r_s = r_d = n' and r_p = 2 n'. Throws
/// std::invalid_argument for fewer than 3 points or points of one temperature.
ThermistorNetwork fit_thermistor_network(
    const Eigen::Ref<const Eigen::ArrayXd>& x,
    const Eigen::Ref<const Eigen::ArrayXd>& y, double b_K);

}  // namespace beamgyro::internal
