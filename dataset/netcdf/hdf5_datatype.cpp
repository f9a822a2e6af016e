// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_datatype.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "dataset/netcdf/hdf5_bytes.h"

namespace beamgyro::internal {
namespace {

// "Datatype Message" of the HDF5 File Format Specification 3.0.
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

/// Reads a description from its beginning.
class TypeDescription {
 public:
  explicit TypeDescription(std::span<const std::byte> bytes) : left_(bytes) {}

  /// The size of a value, or nothing for a description that is not sound.
  std::optional<std::uint64_t> take_type(int depth) {
    if (depth > kDeepestType) return std::nullopt;
    const std::uint64_t first = left_.take(1);
    const Head head{first >> 4, left_.take(3), left_.take(4), depth};
    if (!left_.is_within() || head.size == 0 || !take_rest(first & 0xf, head))
      return std::nullopt;
    return head.size;
  }

 private:
  struct Head {
    std::uint64_t version, bits, size;
    int depth;
  };

  bool take_rest(std::uint64_t type_class, const Head& head) {
    constexpr std::uint64_t kObjectBytes = 8, kRegionBytes = 12,
                            kSequenceBytes = 16;
    switch (type_class) {
      case kFixedPoint:
      case kBitField:
        return take_bits(head.size);
      case kFloatingPoint:
        return take_floating_point(head);
      case kTime:
        return left_.skip(2);
      case kString:
        return true;
      case kReference:
        return (head.bits & 0xf) == 0 ? head.size == kObjectBytes
                                      : head.size == kRegionBytes;
      case kOpaque:
        return left_.skip(head.bits & 0xff);
      case kVariableLength:
        return head.size == kSequenceBytes && take_type(head.depth + 1);
      case kArray:
        return take_array(head);
      case kEnumeration:
        return take_enumeration(head);
      case kCompound:
        return take_members(head);
      default:
        return false;
    }
  }

  /// The place of the first bit and the number of bits.
  bool take_bits(std::uint64_t size) {
    const std::uint64_t first = left_.take(2), count = left_.take(2);
    return left_.is_within() && count > 0 && first + count <= 8 * size;
  }

  bool take_floating_point(const Head& head) {
    constexpr std::size_t kBiasBytes = 4;
    if (!take_bits(head.size)) return false;
    const auto takes_field = [&] {
      const std::uint64_t first = left_.take(1), count = left_.take(1);
      return first + count <= 8 * head.size;
    };
    const bool fields = takes_field() && takes_field();
    return left_.skip(kBiasBytes) && fields &&
           (head.bits >> 8 & 0xff) < 8 * head.size;
  }

  /// A name with its zero byte; before version 3 it takes a multiple of 8.
  bool take_name(std::uint64_t version) {
    const std::span<const std::byte> left = left_.left();
    const auto end = std::ranges::find(left, std::byte{0});
    if (end == left.end()) return false;
    const auto size = static_cast<std::uint64_t>(end - left.begin()) + 1;
    return left_.skip(version < 3 ? (size + 7) / 8 * 8 : size);
  }

  bool take_array(const Head& head) {
    constexpr std::uint64_t kMostDimensions = 32;
    const std::uint64_t rank = left_.take(1);
    if (rank > kMostDimensions || (head.version < 3 && !left_.skip(3)))
      return false;
    std::uint64_t count = 1;
    for (std::uint64_t k = 0; k < rank; ++k)
      if (__builtin_mul_overflow(count, left_.take(4), &count)) return false;
    if (head.version < 3 && !left_.skip(4 * rank)) return false;
    const std::optional<std::uint64_t> element = take_type(head.depth + 1);
    std::uint64_t size = 0;
    return element && !__builtin_mul_overflow(count, *element, &size) &&
           size == head.size;
  }

  bool take_enumeration(const Head& head) {
    if (take_type(head.depth + 1) != head.size) return false;
    const std::uint64_t members = head.bits & 0xffff;
    for (std::uint64_t k = 0; k < members; ++k)
      if (!take_name(head.version)) return false;
    return left_.skip(members * head.size);
  }

  bool take_members(const Head& head) {
    // Before version 3 a place has 4 bytes; in version 1 dimensions follow it,
    // which no library has written since there are arrays.
    constexpr std::size_t kDimensions = 28;
    const auto width =
        static_cast<std::size_t>(std::bit_width(head.size) + 7) / 8;
    const std::uint64_t members = head.bits & 0xffff;
    for (std::uint64_t k = 0; k < members; ++k) {
      if (!take_name(head.version)) return false;
      const std::uint64_t place = left_.take(head.version < 3 ? 4 : width);
      if (head.version == 1) {
        const std::uint64_t rank = left_.take(1);
        if (rank != 0 || !left_.skip(kDimensions - 1)) return false;
      }
      const std::optional<std::uint64_t> size = take_type(head.depth + 1);
      if (!size || place > head.size || *size > head.size - place) return false;
    }
    return true;
  }

  ByteReader left_;
};

}  // namespace

std::optional<std::uint64_t> size_of_datatype(
    std::span<const std::byte> bytes) {
  return TypeDescription(bytes).take_type(0);
}

}  // namespace beamgyro::internal
