// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "dataset/netcdf/hdf5_write.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

// The layout that files of a set and views over them have in common. Each
// function throws Hdf5Error.

/// Makes a new HDF5 file in memory.
H5Id make_image();

/// Returns the present bytes of such a file. They are valid until its next
/// change. All its variables must be closed.
std::span<const std::byte> image_bytes(const H5Id& file);

hid_t file_type(Storage storage);

/// Writes the attributes that say how to read the counts of an integer
/// variable.
void write_scaling(hid_t variable, const SetVariable& about);

VariableAbout part_about();
VariableAbout device_status_about();

/// Write the attributes that name the meanings of their values.
void write_part_flags(hid_t part);
void write_device_status_flags(hid_t device_status);

void write_root_attributes(hid_t file, const ShardHead& head);

/// Writes all values of a variable.
void write_all(hid_t variable, const std::string& name, hid_t memory_type,
               const void* values);

}  // namespace beamgyro::internal
