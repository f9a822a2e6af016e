// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "dataset/hdf5_id.h"
#include "dataset/set/shard.h"

namespace beamgyro {

// The layout that files of a set and views over them have in common. All
// throws Hdf5Error.

hid_t file_type(Storage storage);

H5Id space_of(std::span<const hsize_t> lengths);

/// A variable over the dimension scales `axes`, with its attributes.
struct VariableAbout {
  std::string name, units, long_name;
  Role role = Role::kMeasured;
};

/// `properties`: of its creation. `axes` are dimension scales, one for each
/// dimension, or none for a variable that becomes a scale itself.
H5Id make_variable(hid_t file, const VariableAbout& about, hid_t type,
                   hid_t space, hid_t properties,
                   std::span<const H5Id* const> axes);

/// What tells how the counts of an integer variable read.
void write_scaling(hid_t variable, const SetVariable& about);

VariableAbout status_about();
VariableAbout part_about();
VariableAbout device_status_about();

/// What tells the meanings of their values.
void write_part_flags(hid_t part);
void write_device_status_flags(hid_t device_status);

void write_root_attributes(hid_t file, const ShardHead& head);

/// Whole values of a variable.
void write_all(hid_t variable, const std::string& name, hid_t memory_type,
               const void* values);

}  // namespace beamgyro
