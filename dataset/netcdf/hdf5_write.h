// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "dataset/netcdf/hdf5_id.h"
#include "dataset/recording/signals.h"

namespace beamgyro::internal {

// Functions that write the parts of our files: without time stamps, in the
// order of creation, with texts as fixed-length UTF-8. Each throws Hdf5Error.

H5Id scalar_space();

/// Returns the properties of a new object (H5P_FILE_CREATE, H5P_GROUP_CREATE or
/// H5P_DATASET_CREATE).
H5Id creation_properties(hid_t kind);

/// Writes an attribute. `value` in memory has the same `type`.
void write_attribute(hid_t object, const char* name, hid_t type, hid_t space,
                     const void* value);
void write_text(hid_t object, const char* name, std::string_view text);

/// Writes the root attributes that a Recording and a ShardHead share.
template <class Head>
void write_origin(hid_t file, const char* filetype, std::int32_t version,
                  const Head& head) {
  write_text(file, "Conventions", kConventions);
  write_text(file, "filetype", filetype);
  write_attribute(file, "format_version", H5T_STD_I32LE, scalar_space(),
                  &version);
  write_text(file, "beamgyro_version", head.program_version);
  write_text(file, "git_revision", head.git_revision);
  write_attribute(file, "seed", H5T_STD_U64LE, scalar_space(), &head.seed);
  write_text(file, "fidelity", head.fidelity);
  write_text(
      file, "source",
      source_text(head.fidelity, head.program_version, head.git_revision));
}

/// Writes `attribute` (flag_values or flag_masks) and flag_meanings of a
/// variable.
void write_flags(hid_t variable, const char* attribute,
                 std::span<const std::uint8_t> flags,
                 std::string_view meanings);

H5Id space_of(std::span<const hsize_t> lengths);

/// Makes a variable. `properties` are those of its creation. `axes` are
/// dimension scales, one for each dimension, or none for a variable that
/// becomes a scale itself.
H5Id make_variable(hid_t file, const VariableAbout& about, hid_t type,
                   hid_t space, hid_t properties,
                   std::span<const H5Id* const> axes);

/// Writes the attributes that name the bits of `status`.
void write_status_bits(hid_t status);

struct NamedText {
  const char* name;
  std::string_view text;  // without NUL
};

/// Writes the group /meta with each text in fixed length, ended by NUL. HDF5
/// 1.10 can crash on damage among texts of variable length.
void write_meta(hid_t file, std::span<const NamedText> texts);

}  // namespace beamgyro::internal
