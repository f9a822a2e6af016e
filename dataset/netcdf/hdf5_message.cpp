// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_message.h"

#include <algorithm>
#include <limits>

#include "dataset/netcdf/hdf5_bytes.h"
#include "dataset/netcdf/hdf5_datatype.h"

namespace beamgyro::internal {
namespace {

// The format is "Data Object Header Messages" of the HDF5 File Format
// Specification 3.0, with addresses and lengths of 8 bytes.
using Bytes = std::span<const std::byte>;

constexpr std::size_t kAddress = 8, kLength = 8;
constexpr std::uint64_t kSharedFlag = 0x02;  // of a message
constexpr auto kUndefined = std::numeric_limits<std::uint64_t>::max();

std::uint64_t padded(std::uint64_t size) { return (size + 7) / 8 * 8; }

/// The number of values of a shape; nothing for one that does not end within
/// `bytes`.
std::optional<std::uint64_t> values_of_shape(Bytes bytes) {
  constexpr std::uint64_t kMostDimensions = 32, kSimple = 1, kNull = 2;
  ByteReader in(bytes);
  const std::uint64_t version = in.take(1), rank = in.take(1),
                      flags = in.take(1), kind = in.take(1);
  if (version == 1) in.skip(4);
  if (rank > kMostDimensions || version < 1 || version > 2) return std::nullopt;
  if (version == 2 && (kind > kNull || (kind != kSimple && rank > 0)))
    return std::nullopt;
  std::uint64_t count = version == 2 && kind == kNull ? 0 : 1;
  for (std::uint64_t k = 0; k < rank; ++k)
    if (__builtin_mul_overflow(count, in.take(kLength), &count))
      return std::nullopt;
  const std::uint64_t more = (flags & 1) + (flags >> 1 & 1);  // largest, order
  if (!in.skip(more * rank * kLength)) return std::nullopt;
  return count;
}

/// The parts of an attribute end within its message, and its type and its shape
/// within their parts.
bool is_sound_attribute(Bytes body) {
  constexpr std::uint64_t kSharedParts = 0x03;  // flags of type and shape
  ByteReader in(body);
  const std::uint64_t version = in.take(1), flags = in.take(1),
                      name_size = in.take(2), type_size = in.take(2),
                      shape_size = in.take(2);
  if (version < 1 || version > 3) return false;
  if (version == 3) in.skip(1);  // encoding of the name
  // A type or a shape that stands elsewhere does not tell the size of the
  // values here.
  if (version > 1 && (flags & kSharedParts) != 0) return false;
  const auto room = [&](std::uint64_t size) {
    return version == 1 ? padded(size) : size;
  };
  const Bytes name = in.left();
  if (!in.skip(room(name_size)) || name_size == 0 ||
      std::ranges::find(name.first(name_size), std::byte{0}) ==
          name.begin() + static_cast<std::ptrdiff_t>(name_size))
    return false;
  const Bytes type = in.left();
  if (!in.skip(room(type_size))) return false;
  const Bytes shape = in.left();
  if (!in.skip(room(shape_size))) return false;
  const auto width = size_of_datatype(type.first(type_size));
  const auto values = values_of_shape(shape.first(shape_size));
  std::uint64_t size = 0;
  return width && values && !__builtin_mul_overflow(*width, *values, &size) &&
         in.skip(size);
}

bool is_sound_fill(Bytes body) {
  constexpr std::uint64_t kHasValue = 0x20, kLargestSize = 0x7fffffff;
  ByteReader in(body);
  const std::uint64_t version = in.take(1);
  bool has_value = false;
  if (version == 3) {
    has_value = (in.take(1) & kHasValue) != 0;
  } else {
    in.skip(2);  // when it is written
    const bool is_defined = in.take(1) != 0;
    has_value = version == 1 || is_defined;
  }
  if (has_value)
    if (const std::uint64_t size = in.take(4); size <= kLargestSize)
      in.skip(size);
  return in.is_within();
}

bool is_sound_link(Bytes body) {
  constexpr std::uint64_t kHard = 0;
  ByteReader in(body);
  const std::uint64_t version = in.take(1), flags = in.take(1);
  const std::uint64_t kind = (flags & 0x08) != 0 ? in.take(1) : kHard;
  if ((flags & 0x04) != 0) in.skip(8);  // order of creation
  if ((flags & 0x10) != 0) in.skip(1);  // encoding of the name
  const std::uint64_t name = in.take(std::size_t{1} << (flags & 3));
  if (version != 1 || name == 0 || !in.skip(name)) return false;
  return kind == kHard ? in.skip(kAddress) : in.skip(in.take(2));
}

bool is_sound_external(Bytes body) {
  ByteReader in(body);
  in.skip(4);  // version
  const std::uint64_t room = in.take(2), used = in.take(2);
  return used <= room && in.skip(kAddress) && in.skip(used * 3 * kLength);
}

/// An index of chunks, of layouts of version 4.
bool is_sound_chunk_index(ByteReader in, std::uint64_t flags) {
  constexpr std::uint64_t kSingle = 1, kFixedArray = 3, kGrowingArray = 4,
                          kChunkTree = 5, kFiltered = 0x02;
  const std::uint64_t kind = in.take(1);
  if (kind == kSingle && (flags & kFiltered) != 0) in.skip(kLength + 4);
  if (kind == kFixedArray) in.skip(1);
  if (kind == kGrowingArray) in.skip(5);
  if (kind == kChunkTree) in.skip(6);
  return in.skip(kAddress);
}

bool is_sound_new_layout(ByteReader in, std::uint64_t version) {
  constexpr std::uint64_t kCompact = 0, kContiguous = 1, kChunked = 2,
                          kVirtual = 3;
  constexpr std::uint64_t kMostDimensions = 33, kWidest = 8;
  const std::uint64_t kind = in.take(1);
  if (kind == kCompact) return in.skip(in.take(2));
  if (kind == kContiguous) return in.skip(kAddress + kLength);
  if (kind == kVirtual) return in.skip(kAddress + 4);
  if (kind != kChunked) return false;
  if (version == 3) {
    const std::uint64_t rank = in.take(1);
    return rank > 0 && rank <= kMostDimensions && in.skip(kAddress + 4 * rank);
  }
  const std::uint64_t flags = in.take(1), rank = in.take(1), width = in.take(1);
  return rank > 0 && rank <= kMostDimensions && width > 0 && width <= kWidest &&
         in.skip(rank * width) && is_sound_chunk_index(in, flags);
}

bool is_sound_layout(Bytes body) {
  constexpr std::uint64_t kCompact = 0, kChunked = 2, kMostDimensions = 33;
  ByteReader in(body);
  const std::uint64_t version = in.take(1);
  if (version > 2) return is_sound_new_layout(in, version);
  const std::uint64_t rank = in.take(1), kind = in.take(1);
  in.skip(5);
  if (kind != kCompact) in.skip(kAddress);
  if (rank == 0 || rank > kMostDimensions || kind > kChunked) return false;
  in.skip(4 * rank);  // the last of chunks is the size of a value
  return kind == kCompact ? in.skip(in.take(4)) : in.is_within();
}

bool is_sound_pipeline(Bytes body) {
  constexpr std::uint64_t kMostFilters = 32, kOwnFilters = 256;
  ByteReader in(body);
  const std::uint64_t version = in.take(1), count = in.take(1);
  if (version < 1 || version > 2 || count > kMostFilters) return false;
  if (version == 1) in.skip(6);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t filter = in.take(2);
    const bool is_named = version == 1 || filter >= kOwnFilters;
    const std::uint64_t name = is_named ? in.take(2) : 0;
    in.skip(2);  // flags
    const std::uint64_t values = in.take(2);
    // HDF5 takes a name for text that ends.
    const Bytes left = in.left();
    if (!in.skip(version == 1 ? padded(name) : name) ||
        (name > 0 && std::ranges::find(left.first(name), std::byte{0}) ==
                         left.begin() + static_cast<std::ptrdiff_t>(name)))
      return false;
    in.skip(4 * (version == 1 ? values + values % 2 : values));
  }
  return in.is_within();
}

bool is_sound_comment(Bytes body) {
  return std::ranges::find(body, std::byte{0}) != body.end();
}

bool is_sound_driver(Bytes body) {
  ByteReader in(body);
  in.skip(1 + 8);  // version, name
  return in.skip(in.take(2));
}

/// The widths and addresses that the flags announce.
std::optional<DenseStorage> dense_storage_of(const HeaderMessage& message) {
  ByteReader in(message.body);
  in.skip(1);  // version
  const std::uint64_t flags = in.take(1);
  if ((flags & 1) != 0) in.skip(message.kind == kLinksMessage ? 8 : 2);
  DenseStorage storage{in.take(kAddress), in.take(kAddress), kUndefined};
  if ((flags & 2) != 0) storage.by_creation = in.take(kAddress);
  return in.is_within() ? std::optional(storage) : std::nullopt;
}

bool is_sound_group(Bytes body) {
  ByteReader in(body);
  in.skip(1);  // version
  const std::uint64_t flags = in.take(1);
  return in.skip(4 * ((flags & 1) + (flags >> 1 & 1)));
}

/// A message that stands elsewhere, which HDF5 reads there.
bool is_sound_reference(const HeaderMessage& message) {
  constexpr std::uint64_t kOldReference = 24, kReference = 10;
  const bool is_known =
      message.kind == kShapeMessage || message.kind == kTypeMessage ||
      message.kind == kOldFillMessage || message.kind == kFillMessage ||
      message.kind == kFiltersMessage;
  if (!is_known || message.body.empty()) return false;
  return message.body.size() >=
         (message.body[0] == std::byte{1} ? kOldReference : kReference);
}

}  // namespace

bool is_sound_message(const HeaderMessage& message) {
  const Bytes body = message.body;
  if ((message.flags & kSharedFlag) != 0 &&
      message.kind <= kAttributesMessage && message.kind > 0)
    return is_sound_reference(message);
  switch (message.kind) {
    case kShapeMessage:
      return values_of_shape(body).has_value();
    case kLinksMessage:
    case kAttributesMessage:
      return dense_storage_of(message).has_value();
    case kTypeMessage:
      return size_of_datatype(body).has_value();
    case kOldFillMessage: {
      ByteReader in(body);
      return in.skip(in.take(4));
    }
    case kFillMessage:
      return is_sound_fill(body);
    case kLinkMessage:
      return is_sound_link(body);
    case kExternalMessage:
      return is_sound_external(body);
    case kLayoutMessage:
      return is_sound_layout(body);
    case kGroupMessage:
      return is_sound_group(body);
    case kFiltersMessage:
      return is_sound_pipeline(body);
    case kAttributeMessage:
      return is_sound_attribute(body);
    case kCommentMessage:
      return is_sound_comment(body);
    case kOldTimeMessage:
    case kContinuationMessage:
    case kOldGroupMessage:
      return body.size() >= 16;
    case kSharedTableMessage:
      return body.size() >= 10;
    case kTimeMessage:
      return body.size() >= 8;
    case kWidthsMessage:
      return body.size() >= 7;
    case kDriverMessage:
      return is_sound_driver(body);
    case kCountMessage:
      return body.size() >= 5;
    default:
      return true;
  }
}

std::optional<DenseStorage> dense_storage(const HeaderMessage& message) {
  if (message.kind != kLinksMessage && message.kind != kAttributesMessage)
    return std::nullopt;
  const std::optional<DenseStorage> storage = dense_storage_of(message);
  return storage && storage->heap != kUndefined ? storage : std::nullopt;
}

}  // namespace beamgyro::internal
