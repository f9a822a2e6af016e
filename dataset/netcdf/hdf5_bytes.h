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

/// Takes numbers from the beginning of bytes. One for which they have no room
/// is 0, and so is each after it.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

  std::uint64_t take(std::size_t width) {
    if (!skip(width)) return 0;
    return little_number({left_.data() - width, width}, 0, width);
  }
  /// Returns whether there was room so far.
  bool skip(std::uint64_t count) {
    is_within_ = is_within_ && count <= left_.size();
    if (is_within_) left_ = left_.subspan(count);
    return is_within_;
  }
  bool is_within() const { return is_within_; }
  std::span<const std::byte> left() const { return left_; }

 private:
  std::span<const std::byte> left_;
  bool is_within_ = true;
};

}  // namespace beamgyro::internal
