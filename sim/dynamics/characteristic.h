// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

inline constexpr std::size_t kCharacteristicQuantities = 9;

/// A quantity of the static characteristic.
struct CharacteristicQuantity {
  std::string_view name, units;
  std::string_view heading;  // of its column in CSV
  std::string_view long_name;
};

/// Bias and its two parts, drive frequency, split of the modes, quality
/// factors, drive voltage and scale factor.
std::span<const CharacteristicQuantity, kCharacteristicQuantities>
characteristic_quantities();

/// The quantities at one temperature.
using CharacteristicRow = std::array<double, kCharacteristicQuantities>;

/// Returns the static characteristic of a gyro at rest, free of noise, for each
/// beam temperature [degC].
std::vector<CharacteristicRow> characteristic(
    const TrimmedGyro& gyro, std::span<const double> temperatures);

/// Temperatures at which a gyro does not work as it should.
struct CharacteristicLimits {
  std::size_t not_locked = 0;  // the drive is at its voltage limit
  std::size_t saturated = 0;   // the bias is beyond the full scale
};
CharacteristicLimits limits_met(const DeviceParameters& device,
                                std::span<const CharacteristicRow> rows);

/// Returns it as CSV text: a line of names with units, then a line for each
/// temperature.
std::string characteristic_csv(std::span<const double> temperatures,
                               std::span<const CharacteristicRow> rows);

}  // namespace beamgyro::internal
