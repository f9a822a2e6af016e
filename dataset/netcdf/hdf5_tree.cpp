// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_tree.h"

#include <array>
#include <bit>
#include <string_view>
#include <vector>

#include "dataset/netcdf/hdf5_bytes.h"

namespace beamgyro::internal {
namespace {

// The format is "Version 2 B-trees" of the HDF5 File Format Specification 3.0,
// with addresses and lengths of 8 bytes.
constexpr std::string_view kTreeStart = "BTHD", kInnerStart = "BTIN",
                           kLeafStart = "BTLF";
constexpr std::size_t kAddressBytes = 8;
constexpr std::size_t kNodeHead = 6;               // signature, version, kind
constexpr std::size_t kNodeFrame = kNodeHead + 4;  // and a checksum
constexpr std::uint64_t kDeepest = 8;

/// The size of a record of a kind, or 0 for kinds that no file of beamgyro has.
std::uint64_t record_bytes(std::uint64_t kind) {
  switch (kind) {
    case 5:  // links by name
      return 11;
    case 6:  // links in the order of their creation
      return 15;
    case 8:  // attributes by name
      return 17;
    case 9:  // attributes in the order of their creation
      return 13;
    default:
      return 0;
  }
}

std::uint64_t bytes_to_write(std::uint64_t largest) {
  return (static_cast<std::uint64_t>(std::bit_width(largest)) + 7) / 8;
}

/// What a node of one depth holds.
struct Level {
  std::uint64_t most_records = 0;
  std::uint64_t pointer = 0;     // size of one to a child [bytes]
  std::uint64_t most_below = 0;  // records of the node and all its children
};

using VisitRecord = std::function<bool(std::span<const std::byte> record)>;

struct Tree {
  std::uint64_t node_size, record_size, file_size;
  const VisitRecord& is_sound_record;
  std::uint64_t count_bytes = 0;  // of the number of records of a child
  std::vector<Level> levels = {};
  std::uint64_t nodes = 0;  // that were met
};

/// Adds the levels up to `depth`. Returns false when a node has no room for a
/// record.
bool add_levels(Tree& tree, std::uint64_t depth) {
  if (tree.node_size < kNodeFrame) return false;
  const std::uint64_t in_leaf =
      (tree.node_size - kNodeFrame) / tree.record_size;
  tree.count_bytes = bytes_to_write(in_leaf);
  tree.levels.push_back({in_leaf, 0, in_leaf});
  while (tree.levels.size() <= depth) {
    const std::uint64_t below = tree.levels.back().most_below;
    const std::uint64_t total_bytes =
        tree.levels.size() == 1 ? 0 : bytes_to_write(below);
    const std::uint64_t pointer =
        kAddressBytes + tree.count_bytes + total_bytes;
    if (tree.node_size < kNodeFrame + pointer) return false;
    const std::uint64_t most =
        (tree.node_size - kNodeFrame - pointer) / (tree.record_size + pointer);
    std::uint64_t most_below = 0;
    if (__builtin_mul_overflow(most + 1, below, &most_below) ||
        __builtin_add_overflow(most_below, most, &most_below))
      return false;
    tree.levels.push_back({most, pointer, most_below});
  }
  return tree.levels.back().most_records > 0;
}

template <class Read>
bool is_sound_node(Tree& tree, std::uint64_t depth, std::uint64_t place,
                   std::uint64_t records, const Read& read) {
  const Level& level = tree.levels[depth];
  if (records > level.most_records ||
      ++tree.nodes > tree.file_size / tree.node_size)
    return false;
  if (depth == 0 && !tree.is_sound_record) return true;
  std::vector<std::byte> node(tree.node_size);
  if (!read(place, node) ||
      !starts_with(node, depth == 0 ? kLeafStart : kInnerStart))
    return false;
  for (std::uint64_t k = 0; tree.is_sound_record && k < records; ++k)
    if (!tree.is_sound_record(std::span(node).subspan(
            kNodeHead + k * tree.record_size, tree.record_size)))
      return false;
  if (depth == 0) return true;
  std::size_t pointer = kNodeHead + records * tree.record_size;
  for (std::uint64_t k = 0; k <= records; ++k, pointer += level.pointer) {
    const std::uint64_t child = little_number(node, pointer, kAddressBytes);
    const std::uint64_t count =
        little_number(node, pointer + kAddressBytes, tree.count_bytes);
    if (!is_sound_node(tree, depth - 1, child, count, read)) return false;
  }
  return true;
}

// "Version 1 B-trees" of the same, that index chunks.
constexpr std::string_view kChunkTreeStart = "TREE\x01";
constexpr std::size_t kChunkTreeHead = 24;
constexpr std::size_t kChildren = 64;      // of a node, which HDF5 writes
constexpr std::size_t kBeforePlace = 8;    // of a key: size and filters
constexpr std::uint64_t kMostFilters = 8;  // of a chunk

}  // namespace

bool is_sound_chunk_node(std::span<const std::byte> node) {
  if (!starts_with(node, kChunkTreeStart)) return true;
  const std::size_t children_bytes = kChildren * kAddressBytes;
  if (node.size() < kChunkTreeHead + children_bytes) return true;
  const std::size_t keys = node.size() - kChunkTreeHead - children_bytes;
  const std::size_t key = keys / (kChildren + 1);
  if (keys % (kChildren + 1) != 0 || key <= kBeforePlace || key % 8 != 0)
    return true;  // of another shape
  const std::uint64_t count = little_number(node, 6, 2);
  if (count > kChildren) return false;
  std::vector<std::uint64_t> before, place((key - kBeforePlace) / 8);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = kChunkTreeHead + k * (key + kAddressBytes);
    if (little_number(node, at + 4, 4) >> kMostFilters != 0) return false;
    for (std::size_t i = 0; i < place.size(); ++i)
      place[i] = little_number(node, at + kBeforePlace + 8 * i, 8);
    if (k > 0 && !(before < place)) return false;
    before = place;
  }
  return true;
}

bool is_tree(std::span<const std::byte> header) {
  return starts_with(header, kTreeStart);
}

bool is_sound_tree(std::span<const std::byte> header, std::uint64_t file_size,
                   const std::function<bool(std::uint64_t place,
                                            std::span<std::byte> bytes)>& read,
                   const VisitRecord& is_sound_record) {
  if (header.size() != kTreeHeaderBytes) return false;
  const std::uint64_t kind = little_number(header, kTreeKind, 1),
                      depth = little_number(header, 12, 2);
  const std::uint64_t root = little_number(header, 16, 8);
  const std::uint64_t records = little_number(header, 24, 2);
  Tree tree{.node_size = little_number(header, 6, 4),
            .record_size = little_number(header, 10, 2),
            .file_size = file_size,
            .is_sound_record = is_sound_record};
  return tree.node_size <= file_size && tree.record_size > 0 &&
         tree.record_size == record_bytes(kind) && depth <= kDeepest &&
         add_levels(tree, depth) &&
         (records == 0 || is_sound_node(tree, depth, root, records, read));
}

}  // namespace beamgyro::internal
