// SPDX-License-Identifier: MIT
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "dataset/files/open_file.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_storage.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

// Functions that read a file which may be damaged or made by somebody else.
// Everything that is not as expected throws Hdf5Error.

/// Opens a variable. Throws unless check_storage() accepts it: its values stand
/// in `file`, which is large enough for them.
H5Id open_variable(hid_t file, const std::string& name);

/// Returns the lengths of the dimensions. Throws unless there are `rank` of
/// them.
std::vector<hsize_t> lengths_of(hid_t variable, const std::string& name,
                                int rank);

/// Throws unless the values have the class `expected` and at most `size` bytes
/// each.
void check_type(hid_t variable, const std::string& name, H5T_class_t expected,
                std::size_t size);

/// Reads a variable over one dimension of `length` values; 0 means any length.
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
  check_chunks_of_row(variable, name, 0);
  std::vector<Value> values(found);
  check_hdf5(H5Dread(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                     values.data()),
             "read " + name);
  return values;
}

bool has_attribute(hid_t object, const std::string& owner, const char* name);
/// Reads a text attribute of fixed length. Variable length is an error.
std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name);
/// Reads the attribute `comment`; empty when there is none or another kind of
/// value than a text of fixed length, as other programs write.
std::string comment_of(hid_t object, const std::string& owner);
std::uint64_t integer_attribute(hid_t file, const char* name);
double number_attribute(hid_t object, const std::string& owner,
                        const char* name);

/// Reads the text /meta/`name` of fixed length. Returns an empty text when
/// there is none.
std::string meta_text(hid_t file, const std::string& name);

Role role_of(const std::string& text, const std::string& name);

/// Returns the names of the variables except /meta, in file order.
std::vector<std::string> variable_names(hid_t file);

/// Returns whether the attribute `filetype` has this value.
bool is_of_filetype(hid_t file, const std::string& filetype);

/// Opens an HDF5 file whose attributes say `filetype` and a format_version from
/// 1 to `newest`; `kind` names such a file.
H5Id open_hdf5_file(OpenFile& file, const std::string& filetype,
                    const std::string& kind, std::uint64_t newest);

/// Converts a failed read of the bytes of a file to an Hdf5Error.
Hdf5Error read_failure(const std::system_error& error);

/// Throws `problem` with `path` before it: std::invalid_argument for a defect
/// of the file, std::runtime_error when the system failed to read it.
[[noreturn]] void reject_hdf5_file(const std::filesystem::path& path,
                                   const Hdf5Error& problem);

/// Opens `path` for reading. Throws std::invalid_argument naming it unless it
/// is a file, and FileError when the system fails. `kind` says in messages what
/// file is expected.
OpenFile open_to_read(const std::filesystem::path& path,
                      const std::string& kind);

}  // namespace beamgyro::internal
