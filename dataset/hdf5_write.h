// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "dataset/hdf5_id.h"

namespace beamgyro {

// What every file of ours is made of: no time stamps, everything in the order
// of creation, texts as fixed-length UTF-8. Each throws Hdf5Error.

H5Id scalar_space();

/// The properties of an object (H5P_FILE_CREATE, H5P_GROUP_CREATE or
/// H5P_DATASET_CREATE).
H5Id creation_properties(hid_t kind);

/// `value` in memory is of `type`, too.
void write_attribute(hid_t object, const char* name, hid_t type, hid_t space,
                     const void* value);
void write_text(hid_t object, const char* name, std::string_view text);

/// The root attributes that a Recording and a ShardHead share.
template <class Head>
void write_origin(hid_t file, const char* filetype, std::int32_t version,
                  const Head& head) {
  write_text(file, "Conventions", "CF-1.10");
  write_text(file, "filetype", filetype);
  write_attribute(file, "format_version", H5T_STD_I32LE, scalar_space(),
                  &version);
  write_text(file, "beamgyro_version", head.program_version);
  write_text(file, "git_revision", head.git_revision);
  write_attribute(file, "seed", H5T_STD_U64LE, scalar_space(), &head.seed);
  write_text(file, "fidelity", head.fidelity);
}

/// The attributes that tell which bits `status` has.
void write_status_bits(hid_t status);

struct NamedText {
  const char* name;
  std::string_view text;  // without NUL
};

/// The group /meta with one variable-length text for each.
void write_meta(hid_t file, std::span<const NamedText> texts);

}  // namespace beamgyro
