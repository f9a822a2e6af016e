// SPDX-License-Identifier: MIT
#include "sim/campaign/scrambled_sobol.h"

#include <fmt/format.h>

#include <bit>
#include <boost/random/sobol.hpp>
#include <stdexcept>

#include "random/random_stream.h"

namespace beamgyro::internal {

ScrambledSobol::ScrambledSobol(std::size_t dimensions, std::uint64_t seed)
    : seed_(seed), directions_(dimensions * kIndexBits) {
  if (dimensions > kMostDimensions) {
    throw std::invalid_argument(
        fmt::format("{} numbers to draw for each device; Sobol' points have at "
                    "most {}",
                    dimensions, kMostDimensions));
  }
  if (dimensions == 0) return;
  boost::random::sobol engine(dimensions);
  for (std::size_t bit = 0; bit < kIndexBits; ++bit) {
    // Point 2^(bit+1) - 1 has the Gray code 2^bit; the engine counts from 1.
    engine.seed((std::uint64_t{2} << bit) - 2);
    for (std::size_t d = 0; d < dimensions; ++d)
      directions_[d * kIndexBits + bit] = engine();
  }
}

std::uint64_t ScrambledSobol::digits(std::uint32_t point,
                                     std::size_t dimension) const {
  std::uint64_t result = 0;
  for (std::uint32_t code = point ^ (point >> 1); code != 0; code &= code - 1) {
    result ^= directions_[dimension * kIndexBits +
                          static_cast<std::size_t>(std::countr_zero(code))];
  }
  return result;
}

// The tree of digits is cut into subtrees of seven levels, whose 127 bits come
// from one block of a stream named by dimension, level and the digits above.
std::uint64_t ScrambledSobol::scrambled(std::uint64_t digits,
                                        std::size_t dimension) const {
  constexpr unsigned kLevels = 7, kDigits = 56;
  std::uint64_t result = 0;
  for (unsigned level = 0; level < kDigits; level += kLevels) {
    const std::uint64_t above = level == 0 ? 0 : digits >> (64 - level);
    RandomStream stream(seed_, static_cast<std::uint32_t>(above),
                        static_cast<std::uint32_t>(dimension << 20) |
                            (level / kLevels) << 17 |
                            static_cast<std::uint32_t>(above >> 32),
                        kSobolScrambleStream);
    const std::uint64_t low = stream.next_word(), high = stream.next_word();
    std::uint64_t node = 1;  // 1, then 2 and 3, 4 to 7, ...
    for (unsigned i = 0; i < kLevels; ++i) {
      const std::uint64_t digit = digits >> (63 - level - i) & 1;
      const std::uint64_t flip =
          (node < 64 ? low >> node : high >> (node - 64)) & 1;
      result = result << 1 | (digit ^ flip);
      node = node << 1 | digit;
    }
  }
  return result << (64 - kDigits);
}

double ScrambledSobol::at(std::uint32_t point, std::size_t dimension) const {
  return uniform_number(scrambled(digits(point, dimension), dimension));
}

}  // namespace beamgyro::internal
