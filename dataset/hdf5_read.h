// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/hdf5_id.h"
#include "dataset/recording.h"

namespace beamgyro {

// Reading a file that may be damaged or somebody else's: what is not as
// expected throws Hdf5Error.

H5Id open_variable(hid_t file, const std::string& name);

/// Lengths of the dimensions, of which there have to be `rank`. A file too
/// small for the values it announces is an error, so that memory is safe.
std::vector<hsize_t> lengths_of(hid_t variable, const std::string& name,
                                int rank);

/// That values of class `expected` fit into `size` bytes each.
void check_type(hid_t variable, const std::string& name, H5T_class_t expected,
                std::size_t size);

std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name);
std::uint64_t integer_attribute(hid_t file, const char* name);

/// /meta/`name`, empty when there is none.
std::string meta_text(hid_t file, const std::string& name);

Role role_of(const std::string& text, const std::string& name);

/// Names of the variables beside /meta, in file order.
std::vector<std::string> variable_names(hid_t file);

/// Opens an HDF5 file whose attributes say `filetype` and a format_version from
/// 1 to `newest`; `kind` names such a file.
H5Id open_hdf5_file(const std::string& path, const std::string& filetype,
                    const std::string& kind, std::uint64_t newest);

/// Throws std::invalid_argument naming `path` unless it is a file.
void require_file(const std::filesystem::path& path, const std::string& kind);

}  // namespace beamgyro
