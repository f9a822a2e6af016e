// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace beamgyro::internal {

constexpr std::size_t kLeastRatesOfTable = 5;

/// A rate of a table.
struct HeldRate {
  double rate;    // [deg/s], Omega_i
  double answer;  // [deg/s], V_i, mean
};

/// Linearity of a rate table: the mean answers V_i at the held rates Omega_i of
/// one temperature plateau, compared with their least-squares line V_0 + K
/// Omega.
struct Linearity {
  std::vector<double> departures;  // [ppm], (V_i - line) / (K max |Omega_i|)
  double nonlinearity = 0.0;       // [ppm], the largest of them in size
  double asymmetry = 0.0;  // [ppm], 2 (K+ - K-) / (K+ + K-), of the lines
                           // through the rates >= 0 and <= 0
  std::size_t rates = 0;   // different held rates of that plateau
  double slope = 0.0;      // [-], K
};

/// Returns the linearity of one table, without an order. It is meant for a
/// table that is_rate_table().
Linearity linearity_of(std::span<const HeldRate> table);

/// Returns whether a table has kLeastRatesOfTable rates or more, two of them on
/// each side of zero.
bool is_rate_table(std::span<const HeldRate> table);

}  // namespace beamgyro::internal
