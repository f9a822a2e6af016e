// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "dataset/hdf5_file.h"
#include "dataset/hdf5_id.h"
#include "dataset/recording_defect.h"

namespace beamgyro {
namespace {

hsize_t length_of(hid_t variable, const std::string& name) {
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 1) {
    throw Hdf5Error(
        fmt::format("{} has {} dimensions; expected time alone", name, rank));
  }
  hsize_t length = 0;
  check_hdf5(H5Sget_simple_extent_dims(space, &length, nullptr),
             "size " + name);
  // Deflate packs at most 1032 to 1: more than that was never written.
  if (length / 2048 > H5Dget_storage_size(variable))
    throw Hdf5Error(fmt::format("the values of {} are missing", name));
  return length;
}

H5Id open_variable(hid_t file, const std::string& name) {
  return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open " + name};
}

/// One value per time; `times` is 0 for the time axis itself.
template <class Value>
std::vector<Value> read_values(hid_t variable, const std::string& name,
                               H5T_class_t expected, hid_t memory_type,
                               std::size_t times) {
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  if (H5Tget_class(type) != expected || H5Tget_size(type) > sizeof(Value)) {
    throw Hdf5Error(fmt::format(
        "{} has another type; expected {}", name,
        expected == H5T_FLOAT ? "floating point" : "unsigned bytes"));
  }
  const hsize_t length = length_of(variable, name);
  if (times != 0 && length != times)
    throw Hdf5Error(
        fmt::format("{} has {} values for {} times", name, length, times));
  std::vector<Value> values(length);
  check_hdf5(H5Dread(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                     values.data()),
             "read " + name);
  return values;
}

/// The text that `read` (H5Aread or H5Dread) fills, of one value of `type`.
template <class Read>
std::string read_text(hid_t type, hid_t space, const std::string& what,
                      const Read& read) {
  if (H5Tget_class(type) != H5T_STRING ||
      H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(what + " is no text");
  if (H5Tis_variable_str(type) > 0) {
    char* bytes = nullptr;
    check_hdf5(read(&bytes), "read " + what);
    std::string text = bytes == nullptr ? "" : bytes;
    H5free_memory(bytes);
    return text;
  }
  std::string text(H5Tget_size(type), '\0');
  check_hdf5(read(text.data()), "read " + what);
  return text.substr(0, text.find('\0'));
}

H5Id open_attribute(hid_t object, const std::string& owner, const char* name) {
  if (H5Aexists(object, name) <= 0)
    throw Hdf5Error(fmt::format("{} has no attribute {}", owner, name));
  return {H5Aopen(object, name, H5P_DEFAULT), H5Aclose,
          fmt::format("open attribute {} of {}", name, owner)};
}

std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name) {
  const H5Id attribute = open_attribute(object, owner, name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  return read_text(type, space, fmt::format("attribute {} of {}", name, owner),
                   [&](void* text) { return H5Aread(attribute, type, text); });
}

template <class Value>
Value integer_attribute(hid_t file, const char* name, hid_t memory_type) {
  const H5Id attribute = open_attribute(file, "the file", name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  if (H5Tget_class(type) != H5T_INTEGER ||
      H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(fmt::format("attribute {} is no integer", name));
  Value value = 0;
  check_hdf5(H5Aread(attribute, memory_type, &value), "read an integer");
  return value;
}

std::string meta_text(hid_t file, const std::string& name) {
  if (H5Lexists(file, "meta", H5P_DEFAULT) <= 0 ||
      H5Lexists(file, ("meta/" + name).c_str(), H5P_DEFAULT) <= 0)
    return {};
  const H5Id dataset = open_variable(file, "meta/" + name);
  const H5Id type(H5Dget_type(dataset), H5Tclose, "read a type");
  const H5Id space(H5Dget_space(dataset), H5Sclose, "read a size");
  return read_text(type, space, "/meta/" + name, [&](void* text) {
    return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
  });
}

Role role_of(const std::string& text, const std::string& name) {
  for (const Role role : {Role::kMeasured, Role::kTruth, Role::kCompensated}) {
    if (text == role_name(role)) return role;
  }
  throw Hdf5Error(fmt::format(
      "{} has the role '{}'; expected measured, truth or compensated", name,
      text));
}

/// Names of the variables beside time, status and meta, in file order.
std::vector<std::string> column_names(hid_t file) {
  const H5Id root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose, "open /");
  const H5Id create(H5Gget_create_plist(root), H5Pclose, "read properties");
  unsigned order = 0;
  check_hdf5(H5Pget_link_creation_order(create, &order), "read properties");
  const H5_index_t index =
      (order & H5P_CRT_ORDER_INDEXED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  H5G_info_t info{};
  check_hdf5(H5Gget_info(root, &info), "list the variables");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    std::array<char, 256> name{};
    const ssize_t length =
        H5Lget_name_by_idx(root, ".", index, H5_ITER_INC, i, name.data(),
                           name.size(), H5P_DEFAULT);
    check_hdf5(length < 0 ? -1 : 0, "list the variables");
    const std::string_view text = name.data();
    if (text != "time" && text != "status" && text != "meta")
      names.emplace_back(text);
  }
  return names;
}

void check_filetype(hid_t file) {
  if (H5Aexists(file, "filetype") <= 0 ||
      text_attribute(file, "the file", "filetype") != kRecordingFiletype)
    throw Hdf5Error(fmt::format(
        "not a recording of beamgyro; expected the attribute filetype = \"{}\"",
        kRecordingFiletype));
  const auto version =
      integer_attribute<int>(file, "format_version", H5T_NATIVE_INT);
  if (version < 1 || version > kRecordingFormatVersion) {
    throw Hdf5Error(
        fmt::format("format_version {} is not known; this program "
                    "reads up to {}",
                    version, kRecordingFormatVersion));
  }
}

Recording read_file(const std::string& name) {
  if (H5Fis_hdf5(name.c_str()) <= 0)
    throw Hdf5Error("not an HDF5 file; expected a recording of beamgyro");
  const H5Id file(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access_properties()),
                  H5Fclose, "open the file");
  check_filetype(file);
  Recording recording;
  recording.program_version =
      text_attribute(file, "the file", "beamgyro_version");
  recording.git_revision = text_attribute(file, "the file", "git_revision");
  recording.fidelity = text_attribute(file, "the file", "fidelity");
  recording.seed =
      integer_attribute<std::uint64_t>(file, "seed", H5T_NATIVE_UINT64);
  recording.scenario_text = meta_text(file, "scenario");
  recording.device_text = meta_text(file, "device");
  recording.overrides_text = meta_text(file, "overrides");

  const H5Id time = open_variable(file, "time");
  recording.time =
      read_values<double>(time, "time", H5T_FLOAT, H5T_NATIVE_DOUBLE, 0);
  const std::size_t times = recording.time.size();
  const H5Id status = open_variable(file, "status");
  recording.status = read_values<std::uint8_t>(status, "status", H5T_INTEGER,
                                               H5T_NATIVE_UINT8, times);
  for (const std::string& column : column_names(file)) {
    const H5Id variable = open_variable(file, column);
    recording.columns.push_back(
        {column, text_attribute(variable, column, "units"),
         text_attribute(variable, column, "long_name"),
         role_of(text_attribute(variable, column, "role"), column),
         read_values<double>(variable, column, H5T_FLOAT, H5T_NATIVE_DOUBLE,
                             times)});
  }
  const std::string defect = recording_defect(recording);
  if (!defect.empty()) throw Hdf5Error(defect);
  return recording;
}

}  // namespace

Recording read_recording(const std::filesystem::path& path) {
  const auto reject = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}", path.string(), why));
  };
  std::error_code error;
  const std::filesystem::file_status status =
      std::filesystem::status(path, error);
  if (error) reject("cannot read: " + error.message());
  if (!std::filesystem::is_regular_file(status))
    reject("not a file; expected a recording of beamgyro");
  const QuietHdf5 quiet;
  try {
    return read_file(path.string());
  } catch (const Hdf5Error& problem) {
    reject(problem.what());
  }
  return {};
}

}  // namespace beamgyro
