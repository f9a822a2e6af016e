// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_header.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "dataset/netcdf/hdf5_bytes.h"
#include "dataset/netcdf/hdf5_datatype.h"

namespace beamgyro::internal {
namespace {

// The format is "Data Object Headers" of the HDF5 File Format Specification
// 3.0, with addresses and lengths of 8 bytes.
using Bytes = std::span<const std::byte>;

constexpr std::string_view kHeader = "OHDR", kContinuation = "OCHK";
constexpr std::size_t kSignature = 4, kSum = 4;
constexpr std::uint64_t kTypeKind = 0x03, kAttributeKind = 0x0c,
                        kContinuationKind = 0x10;
constexpr std::uint64_t kShared = 0x02;      // flag of a message
constexpr std::size_t kMostBytes = 1 << 24;  // of messages in one piece
constexpr std::size_t kMostContinuations = 1000;

/// Where messages stand in the file, and what is before each.
struct Messages {
  std::uint64_t place = 0, size = 0;
  bool is_old = false;         // version 1: without signatures and sums
  std::size_t head_bytes = 4;  // of each message
};

struct Message {
  std::uint64_t kind, flags;
  Bytes body;
};

/// The parts of an attribute end within its message, and its type within its
/// part.
bool is_sound_attribute(const Message& message) {
  constexpr std::size_t kParts = 8, kNameSize = 2, kTypeSize = 4,
                        kShapeSize = 6;
  constexpr std::uint64_t kSharedType = 0x01;  // flag of an attribute
  const Bytes body = message.body;
  if ((message.flags & kShared) != 0 || body.size() < kParts) return false;
  const std::uint64_t version = little_number(body, 0, 1);
  const auto room_of = [&](std::size_t part) {
    const std::uint64_t size = little_number(body, part, 2);
    return version == 1 ? (size + 7) / 8 * 8 : size;
  };
  const std::uint64_t type =
      (version == 3 ? kParts + 1 : kParts) + room_of(kNameSize);
  if (type + room_of(kTypeSize) + room_of(kShapeSize) > body.size())
    return false;
  const bool is_shared =
      version > 1 && (little_number(body, 1, 1) & kSharedType) != 0;
  return is_shared || is_sound_datatype(body.subspan(
                          type, little_number(body, kTypeSize, 2)));
}

/// Whether HDF5 finds all that it looks for within a message.
bool is_sound_message(const Message& message) {
  if (message.kind == kAttributeKind) return is_sound_attribute(message);
  if (message.kind == kTypeKind && (message.flags & kShared) == 0)
    return is_sound_datatype(message.body);
  return true;
}

/// The messages of a header; nothing for one that is cut off.
std::optional<Messages> messages_of_header(std::uint64_t place, Bytes bytes) {
  constexpr std::size_t kOldHead = 16, kTimes = 16, kLimits = 4;
  constexpr std::size_t kFlags = 5;  // after signature and version
  if (bytes.size() < kOldHead) return std::nullopt;
  if (!starts_with(bytes, kHeader))
    return Messages{place + kOldHead, little_number(bytes, 8, 4), true, 8};
  const std::uint64_t flags = little_number(bytes, kFlags, 1);
  const std::size_t width = std::size_t{1} << (flags & 3);
  std::size_t head = kFlags + 1;
  if ((flags & 0x20) != 0) head += kTimes;
  if ((flags & 0x10) != 0) head += kLimits;
  if (bytes.size() < head + width) return std::nullopt;
  return Messages{place + head + width, little_number(bytes, head, width),
                  false, (flags & 0x04) != 0 ? std::size_t{6} : std::size_t{4}};
}

std::optional<Messages> continued(const Messages& from,
                                  const Message& message) {
  constexpr std::size_t kBytes = 16;
  if (message.body.size() < kBytes) return std::nullopt;
  const std::size_t before = from.is_old ? 0 : kSignature;
  const std::size_t around = from.is_old ? 0 : kSignature + kSum;
  const std::uint64_t size = little_number(message.body, 8, 8);
  if (size < around) return std::nullopt;
  return Messages{little_number(message.body, 0, 8) + before, size - around,
                  from.is_old, from.head_bytes};
}

/// The message at the beginning of `bytes`, which become what follows it;
/// nothing where they have no room for it.
std::optional<Message> take_message(Bytes& bytes, const Messages& from) {
  const std::size_t kind_bytes = from.is_old ? 2 : 1;
  if (bytes.size() < from.head_bytes) return std::nullopt;
  const std::uint64_t size = little_number(bytes, kind_bytes, 2);
  const Message message{little_number(bytes, 0, kind_bytes),
                        little_number(bytes, kind_bytes + 2, 1),
                        {}};
  bytes = bytes.subspan(from.head_bytes);
  if (size > bytes.size()) return std::nullopt;
  const Bytes body = bytes.first(size);
  bytes = bytes.subspan(size);
  return Message{message.kind, message.flags, body};
}

}  // namespace

bool ObjectHeaders::are_sound(std::uint64_t place, Bytes bytes, bool is_header,
                              const Read& read) {
  const bool is_new = starts_with(bytes, kHeader);
  const bool is_old = is_header && !bytes.empty() && bytes[0] == std::byte{1} &&
                      !parts_.contains(place);
  // A part is looked at with the header that names it.
  if (starts_with(bytes, kContinuation)) return parts_.contains(place);
  if (!is_new && !is_old) return true;
  const std::optional<Messages> first = messages_of_header(place, bytes);
  if (!first) return false;
  // HDF5 reads the beginning first and then what is left.
  parts_.insert(place + bytes.size());
  std::vector<Messages> left{*first};
  for (std::size_t count = 0; !left.empty(); ++count) {
    const Messages from = left.back();
    left.pop_back();
    if (from.size > kMostBytes || count > kMostContinuations) return false;
    std::vector<std::byte> content(from.size);
    if (!read(from.place, content)) return false;
    Bytes rest = content;
    while (rest.size() >= from.head_bytes) {
      const std::optional<Message> message = take_message(rest, from);
      if (!message) break;  // a gap at the end, or what HDF5 refuses
      if (!is_sound_message(*message)) return false;
      if (message->kind != kContinuationKind) continue;
      const std::optional<Messages> next = continued(from, *message);
      if (!next) return false;
      parts_.insert(little_number(message->body, 0, 8));
      left.push_back(*next);
    }
  }
  return true;
}

}  // namespace beamgyro::internal
