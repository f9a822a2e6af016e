// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace beamgyro::internal {

// Bytes of an HDF5 file as its format has them.

inline bool starts_with(std::span<const std::byte> bytes,
                        std::string_view start) {
  return bytes.size() >= start.size() &&
         std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

/// Returns the number of `width` bytes at `place`, the least byte first.
inline std::uint64_t little_number(std::span<const std::byte> bytes,
                                   std::size_t place, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t k = width; k-- > 0;)
    value = value << 8 | std::to_integer<std::uint64_t>(bytes[place + k]);
  return value;
}

}  // namespace beamgyro::internal
