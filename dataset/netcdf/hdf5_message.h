// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace beamgyro::internal {

/// Kinds of messages in the headers of objects.
enum MessageKind : std::uint64_t {
  kShapeMessage = 0x01,
  kLinksMessage = 0x02,
  kTypeMessage = 0x03,
  kOldFillMessage = 0x04,
  kFillMessage = 0x05,
  kLinkMessage = 0x06,
  kExternalMessage = 0x07,
  kLayoutMessage = 0x08,
  kGroupMessage = 0x0a,
  kFiltersMessage = 0x0b,
  kAttributeMessage = 0x0c,
  kCommentMessage = 0x0d,
  kOldTimeMessage = 0x0e,
  kSharedTableMessage = 0x0f,
  kContinuationMessage = 0x10,
  kOldGroupMessage = 0x11,
  kTimeMessage = 0x12,
  kWidthsMessage = 0x13,
  kDriverMessage = 0x14,
  kAttributesMessage = 0x15,
  kCountMessage = 0x16
};

struct HeaderMessage {
  std::uint64_t kind, flags;
  std::span<const std::byte> body;
};

/// Returns whether all that HDF5 1.10 looks for in a message ends within it, by
/// the sizes that the message claims; HDF5 reads what lies behind where it does
/// not. True for kinds that HDF5 does not know.
bool is_sound_message(const HeaderMessage& message);

/// Where the links or the attributes of an object stand that has too many for
/// its header: a heap of them and trees that order them by name and by the
/// time of their creation. An address that is not there has all its bits set.
struct DenseStorage {
  std::uint64_t heap, by_name, by_creation;
};

/// What a sound message of kind kLinksMessage or kAttributesMessage tells.
/// Nothing where the header has all of them.
std::optional<DenseStorage> dense_storage(const HeaderMessage& message);

}  // namespace beamgyro::internal
