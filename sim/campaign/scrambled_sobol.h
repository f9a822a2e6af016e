// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace beamgyro::internal {

/// Sobol' points with the direction numbers of Joe and Kuo (2008) in Gray-code
/// order, point 0 the origin, and Owen's nested uniform scrambling (1995): each
/// binary digit is flipped by a random bit that depends on the seed, the
/// dimension and all digits before it. Any point can be computed by itself, in
/// any order.
class ScrambledSobol {
 public:
  static constexpr std::size_t kMostDimensions = 3667;

  /// Throws std::invalid_argument for more than kMostDimensions.
  ScrambledSobol(std::size_t dimensions, std::uint64_t seed);

  /// Returns the unscrambled coordinate as a binary fraction of 64 digits.
  std::uint64_t digits(std::uint32_t point, std::size_t dimension) const;

  /// Returns the scrambled coordinate, an odd multiple of 2^-53 in (0, 1).
  double at(std::uint32_t point, std::size_t dimension) const;

 private:
  static constexpr std::size_t kIndexBits = 32;

  std::uint64_t scrambled(std::uint64_t digits, std::size_t dimension) const;

  std::uint64_t seed_;
  std::vector<std::uint64_t> directions_;  // dimension x index bit
};

}  // namespace beamgyro::internal
