// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace beamgyro::internal {

/// A checksum within the metadata of an HDF5 file, of the bytes from `begin` to
/// `end`. Where it stands among these bytes, it counts as zeros.
struct MetadataSum {
  std::size_t begin, end, place;
};

/// Returns the checksums of HDF5's metadata in a valid file. They are found by
/// trying: after the signature of a block, which end makes a sum right?
std::vector<MetadataSum> metadata_sums(std::span<const std::uint8_t> file);

/// Sets these checksums to those of the bytes as they are. Without it nearly
/// every change of a file ends at HDF5's first look.
void mend_metadata(std::span<std::uint8_t> file,
                   std::span<const MetadataSum> sums);

/// Applies a list of changes to a file: each is 4 bytes of a place, modulo the
/// size of the file, one of a count (1 to 8, modulo 8) and so many bytes. The
/// last one may be cut off.
void apply_patches(std::span<std::uint8_t> file,
                   std::span<const std::uint8_t> patches);

}  // namespace beamgyro::internal

/// For tests in Python: applies the patches to a file whose sums are known.
extern "C" {
/// Returns the number of sums of a file; fills at most `room` triples.
std::size_t find_metadata_sums(const std::uint8_t* file, std::size_t size,
                               beamgyro::internal::MetadataSum* sums,
                               std::size_t room);
void mend_metadata_sums(std::uint8_t* file, std::size_t size,
                        const beamgyro::internal::MetadataSum* sums,
                        std::size_t count);
}
