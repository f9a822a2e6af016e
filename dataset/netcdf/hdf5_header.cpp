// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_header.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "dataset/netcdf/hdf5_bytes.h"
#include "dataset/netcdf/hdf5_dense.h"
#include "dataset/netcdf/hdf5_message.h"

namespace beamgyro::internal {
namespace {

// The format is "Data Object Headers" of the HDF5 File Format Specification
// 3.0, with addresses and lengths of 8 bytes.
using Bytes = std::span<const std::byte>;

constexpr std::string_view kHeader = "OHDR", kContinuation = "OCHK";
constexpr std::size_t kSignature = 4, kSum = 4;
constexpr std::size_t kMostBytes = 1 << 24;  // of messages in one piece
constexpr std::size_t kMostContinuations = 1000;

/// Where messages stand in the file, and what is before each.
struct Messages {
  std::uint64_t place = 0, size = 0;
  bool is_old = false;         // version 1: without signatures and sums
  std::size_t head_bytes = 4;  // of each message
};

/// A message is sound, and so is what the heap has to which it leads.
bool is_sound_here(const HeaderMessage& message, std::uint64_t file_size,
                   const ObjectHeaders::Read& read) {
  if (!is_sound_message(message)) return false;
  const std::optional<DenseStorage> storage = dense_storage(message);
  return !storage ||
         is_sound_storage(
             *storage,
             message.kind == kLinksMessage ? kLinkMessage : kAttributeMessage,
             file_size, read);
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
                                  const HeaderMessage& message) {
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
std::optional<HeaderMessage> take_message(Bytes& bytes, const Messages& from) {
  const std::size_t kind_bytes = from.is_old ? 2 : 1;
  if (bytes.size() < from.head_bytes) return std::nullopt;
  const std::uint64_t size = little_number(bytes, kind_bytes, 2);
  const HeaderMessage message{little_number(bytes, 0, kind_bytes),
                              little_number(bytes, kind_bytes + 2, 1),
                              {}};
  bytes = bytes.subspan(from.head_bytes);
  if (size > bytes.size()) return std::nullopt;
  const Bytes body = bytes.first(size);
  bytes = bytes.subspan(size);
  return HeaderMessage{message.kind, message.flags, body};
}

}  // namespace

bool ObjectHeaders::are_sound(std::uint64_t place, Bytes bytes, bool is_header,
                              std::uint64_t file_size, const Read& read) {
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
      const std::optional<HeaderMessage> message = take_message(rest, from);
      if (!message) break;  // a gap at the end, or what HDF5 refuses
      if (!is_sound_here(*message, file_size, read)) return false;
      if (message->kind != kContinuationMessage) continue;
      const std::optional<Messages> next = continued(from, *message);
      if (!next) return false;
      parts_.insert(little_number(message->body, 0, 8));
      left.push_back(*next);
    }
  }
  return true;
}

}  // namespace beamgyro::internal
