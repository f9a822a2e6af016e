// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "dataset/hdf5_id.h"
#include "dataset/open_file.h"
#include "dataset/recording.h"

namespace beamgyro {

// Reading a file that may be damaged or somebody else's: what is not as
// expected throws Hdf5Error.

/// Of a variable that stands in `file`, as check_storage() asks: nothing leads
/// out of the file, and it is large enough for the values it announces.
H5Id open_variable(hid_t file, const std::string& name);

/// Lengths of the dimensions, of which there have to be `rank`.
std::vector<hsize_t> lengths_of(hid_t variable, const std::string& name,
                                int rank);

/// That values of class `expected` fit into `size` bytes each.
void check_type(hid_t variable, const std::string& name, H5T_class_t expected,
                std::size_t size);

/// A variable over one dimension of `length`, or of any if that is 0.
template <class Value>
std::vector<Value> read_values(hid_t file, const std::string& name,
                               H5T_class_t expected, hid_t memory_type,
                               std::size_t length) {
  const H5Id variable = open_variable(file, name);
  check_type(variable, name, expected, sizeof(Value));
  const hsize_t found = lengths_of(variable, name, 1).front();
  if (length != 0 && found != length)
    throw Hdf5Error(name + " has " + std::to_string(found) +
                    " values; expected " + std::to_string(length));
  std::vector<Value> values(found);
  check_hdf5(H5Dread(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                     values.data()),
             "read " + name);
  return values;
}

bool has_attribute(hid_t object, const std::string& owner, const char* name);
/// Of fixed length; text of variable length is an error.
std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name);
std::uint64_t integer_attribute(hid_t file, const char* name);
double number_attribute(hid_t object, const std::string& owner,
                        const char* name);

/// /meta/`name`, of fixed length; empty when there is none.
std::string meta_text(hid_t file, const std::string& name);

Role role_of(const std::string& text, const std::string& name);

/// Names of the variables beside /meta, in file order.
std::vector<std::string> variable_names(hid_t file);

/// Whether the attribute `filetype` says so.
bool is_of_filetype(hid_t file, const std::string& filetype);

/// Opens an HDF5 file whose attributes say `filetype` and a format_version from
/// 1 to `newest`; `kind` names such a file.
H5Id open_hdf5_file(OpenFile& file, const std::string& filetype,
                    const std::string& kind, std::uint64_t newest);

/// What a failed read of the file's bytes is among those of HDF5.
Hdf5Error read_failure(const std::system_error& error);

/// Throws `problem` with `path` before it: std::invalid_argument for what the
/// file is, std::runtime_error when the system failed to read it.
[[noreturn]] void reject_hdf5_file(const std::filesystem::path& path,
                                   const Hdf5Error& problem);

/// Opens `path` to be read. Throws std::invalid_argument naming it unless it is
/// a file, a `kind` for short, and FileError when the system fails.
OpenFile open_to_read(const std::filesystem::path& path,
                      const std::string& kind);

}  // namespace beamgyro
