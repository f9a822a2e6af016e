// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_datatype.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "dataset/netcdf/hdf5_bytes.h"

namespace beamgyro::internal {
namespace {

// "Datatype Message" of the HDF5 File Format Specification 3.0.
constexpr std::size_t kTypeHead = 8;  // version and class, bits, size
constexpr int kDeepestType = 8;

enum TypeClass : std::uint8_t {
  kFixedPoint,
  kFloatingPoint,
  kTime,
  kString,
  kBitField,
  kOpaque,
  kCompound,
  kReference,
  kEnumeration,
  kVariableLength,
  kArray
};

/// Reads a description from its beginning. Every take returns false where the
/// bytes have no room for it.
class TypeDescription {
 public:
  explicit TypeDescription(std::span<const std::byte> bytes) : left_(bytes) {}

  bool take_type(int depth) {
    if (depth > kDeepestType || left_.size() < kTypeHead) return false;
    const std::uint64_t first = little_number(left_, 0, 1);
    const std::uint64_t version = first >> 4;
    const std::uint64_t bits = little_number(left_, 1, 3);
    const std::uint64_t size = little_number(left_, 4, 4);
    left_ = left_.subspan(kTypeHead);
    switch (first & 0xf) {
      case kFixedPoint:
      case kBitField:
        return skip(4);
      case kFloatingPoint:
        return skip(12);
      case kTime:
        return skip(2);
      case kString:
      case kReference:
        return true;
      case kOpaque:
        return skip(bits & 0xff);
      case kVariableLength:
        return take_type(depth + 1);
      case kArray:
        return take_array(version) && take_type(depth + 1);
      case kEnumeration:
        return take_enumeration(version, bits & 0xffff, depth);
      case kCompound:
        return take_members(version, bits & 0xffff, size, depth);
      default:
        return false;
    }
  }

 private:
  bool skip(std::uint64_t count) {
    if (count > left_.size()) return false;
    left_ = left_.subspan(count);
    return true;
  }

  /// A name with its zero byte; before version 3 it takes a multiple of 8.
  bool take_name(std::uint64_t version) {
    const auto end = std::ranges::find(left_, std::byte{0});
    if (end == left_.end()) return false;
    const auto size = static_cast<std::uint64_t>(end - left_.begin()) + 1;
    return skip(version < 3 ? (size + 7) / 8 * 8 : size);
  }

  bool take_array(std::uint64_t version) {
    constexpr std::uint64_t kMostDimensions = 32;
    if (left_.empty()) return false;
    const std::uint64_t rank = little_number(left_, 0, 1);
    if (rank > kMostDimensions) return false;
    return skip(version < 3 ? 4 + 8 * rank : 1 + 4 * rank);
  }

  bool take_enumeration(std::uint64_t version, std::uint64_t members,
                        int depth) {
    if (left_.size() < kTypeHead) return false;
    const std::uint64_t value_size = little_number(left_, 4, 4);
    if (!take_type(depth + 1)) return false;
    for (std::uint64_t k = 0; k < members; ++k)
      if (!take_name(version)) return false;
    return skip(members * value_size);
  }

  bool take_members(std::uint64_t version, std::uint64_t members,
                    std::uint64_t size, int depth) {
    // Before version 3 a place has 4 bytes; in version 1 dimensions follow it.
    const auto width = static_cast<std::uint64_t>(std::bit_width(size) + 7) / 8;
    for (std::uint64_t k = 0; k < members; ++k) {
      if (!take_name(version) || !skip(version < 3 ? 4 : width) ||
          (version == 1 && !skip(28)) || !take_type(depth + 1))
        return false;
    }
    return true;
  }

  std::span<const std::byte> left_;
};

}  // namespace

bool is_sound_datatype(std::span<const std::byte> bytes) {
  return TypeDescription(bytes).take_type(0);
}

}  // namespace beamgyro::internal
