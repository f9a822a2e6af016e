// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_dense.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "dataset/netcdf/hdf5_bytes.h"
#include "dataset/netcdf/hdf5_heap.h"
#include "dataset/netcdf/hdf5_tree.h"

namespace beamgyro::internal {
namespace {

using Bytes = std::span<const std::byte>;
using Read =
    std::function<bool(std::uint64_t place, std::span<std::byte> bytes)>;

/// The messages that records of trees name.
class DenseMessages {
 public:
  DenseMessages(const FractalHeap& heap, MessageKind kind,
                std::uint64_t file_size, const Read& read)
      : heap_(heap), read_(read), kind_(kind), left_(kTrees * file_size) {}

  /// The identifier in the heap stands in the record at `place`.
  bool is_sound(Bytes record, std::size_t place) {
    const std::size_t size = kind_ == kAttributeMessage ? 8 : 7;
    if (kind_ == kAttributeMessage &&
        (little_number(record, kAttributeId, 1) & kShared) != 0)
      return false;
    const std::optional<HeapObject> object =
        heap_.object(record.subspan(place, size), read_);
    // All messages of a file fit into it, once for each tree.
    if (!object || object->size > left_) return false;
    left_ -= object->size;
    std::vector<std::byte> body(object->size);
    return read_(object->place, body) && is_sound_message({kind_, 0, body});
  }

 private:
  static constexpr std::uint64_t kTrees = 2, kShared = 0x02;
  static constexpr std::size_t kAttributeId = 8;  // the flags stand behind it
  const FractalHeap& heap_;
  const Read& read_;
  MessageKind kind_;
  std::uint64_t left_;  // [bytes]
};

/// A tree whose records have the kind `tree_kind`.
bool is_sound_index(std::uint64_t place, std::uint64_t tree_kind,
                    std::size_t identifier, DenseMessages& messages,
                    std::uint64_t file_size, const Read& read) {
  if (place == std::numeric_limits<std::uint64_t>::max()) return true;
  std::array<std::byte, kTreeHeaderBytes> header{};
  return read(place, header) && is_tree(header) &&
         little_number(header, kTreeKind, 1) == tree_kind &&
         is_sound_tree(header, file_size, read, [&](Bytes record) {
           return messages.is_sound(record, identifier);
         });
}

}  // namespace

bool is_sound_storage(const DenseStorage& storage, MessageKind kind,
                      std::uint64_t file_size, const Read& read) {
  constexpr std::uint64_t kLinksByName = 5, kLinksByCreation = 6,
                          kAttributesByName = 8, kAttributesByCreation = 9;
  constexpr std::size_t kAfterHash = 4, kAfterOrder = 8;
  const std::optional<FractalHeap> heap = FractalHeap::at(storage.heap, read);
  if (!heap) return false;
  DenseMessages messages(*heap, kind, file_size, read);
  const bool are_links = kind == kLinkMessage;
  return is_sound_index(
             storage.by_name, are_links ? kLinksByName : kAttributesByName,
             are_links ? kAfterHash : 0, messages, file_size, read) &&
         is_sound_index(storage.by_creation,
                        are_links ? kLinksByCreation : kAttributesByCreation,
                        are_links ? kAfterOrder : 0, messages, file_size, read);
}

}  // namespace beamgyro::internal
