// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace beamgyro::internal {

/// Number k of a sequence in [-1, 1) without correlation between its members:
/// k^2 times the golden section, modulo 1 (Weyl, Mathematische Annalen 77
/// (1916) 313).
inline double white_number(std::size_t k) {
  const auto i = static_cast<double>(k);
  const double turns = std::fmod(i * i * (std::numbers::phi - 1.0), 1.0);
  return 2.0 * turns - 1.0;
}

}  // namespace beamgyro::internal
