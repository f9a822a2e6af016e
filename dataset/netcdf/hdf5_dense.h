// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "dataset/netcdf/hdf5_message.h"

namespace beamgyro::internal {

/// Returns whether every link or attribute that the trees name is a sound
/// message (is_sound_message()) within its block of the heap. HDF5 1.10 reads a
/// message there as it does in a header, beyond its block if it says so. `kind`
/// is kLinkMessage or kAttributeMessage. `read` fills bytes from a place of the
/// file, which has `file_size` bytes, or returns false.
bool is_sound_storage(
    const DenseStorage& storage, MessageKind kind, std::uint64_t file_size,
    const std::function<bool(std::uint64_t place, std::span<std::byte> bytes)>&
        read);

}  // namespace beamgyro::internal
