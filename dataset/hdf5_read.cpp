// SPDX-License-Identifier: MIT
#include "dataset/hdf5_read.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace beamgyro {
namespace {

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

/// A class of types and what a message calls it.
struct NumberKind {
  H5T_class_t type_class;
  const char* name;
};

/// One number of `kind` into `value`, which is of `memory_type`.
void read_number(hid_t object, const std::string& owner, const char* name,
                 const NumberKind& kind, hid_t memory_type, void* value) {
  const H5Id attribute = open_attribute(object, owner, name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  if (H5Tget_class(type) != kind.type_class ||
      H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(
        fmt::format("attribute {} of {} is no {}", name, owner, kind.name));
  check_hdf5(H5Aread(attribute, memory_type, value),
             fmt::format("read attribute {} of {}", name, owner));
}

}  // namespace

H5Id open_variable(hid_t file, const std::string& name) {
  return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open " + name};
}

std::vector<hsize_t> lengths_of(hid_t variable, const std::string& name,
                                int rank) {
  const H5Id space(H5Dget_space(variable), H5Sclose, "open " + name);
  const int found = H5Sget_simple_extent_ndims(space);
  if (found != rank) {
    throw Hdf5Error(fmt::format("{} has {} dimensions; expected {}", name,
                                found, rank == 1 ? "one" : "two"));
  }
  std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
  check_hdf5(H5Sget_simple_extent_dims(space, lengths.data(), nullptr),
             "size " + name);
  // Deflate packs at most 1032 to 1: more than that was never written.
  hsize_t room = H5Dget_storage_size(variable) * 2048 + 2047;
  for (const hsize_t length : lengths) {
    if (length > room)
      throw Hdf5Error(fmt::format("the values of {} are missing", name));
    if (length > 0) room /= length;
  }
  return lengths;
}

void check_type(hid_t variable, const std::string& name, H5T_class_t expected,
                std::size_t size) {
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  if (H5Tget_class(type) == expected && H5Tget_size(type) <= size) return;
  throw Hdf5Error(fmt::format("{} has another type; expected {}", name,
                              expected == H5T_FLOAT ? "floating point"
                              : size == 1           ? "unsigned bytes"
                                                    : "integers"));
}

std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name) {
  const H5Id attribute = open_attribute(object, owner, name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  return read_text(type, space, fmt::format("attribute {} of {}", name, owner),
                   [&](void* text) { return H5Aread(attribute, type, text); });
}

std::uint64_t integer_attribute(hid_t file, const char* name) {
  std::uint64_t value = 0;
  read_number(file, "the file", name, {H5T_INTEGER, "integer"},
              H5T_NATIVE_UINT64, &value);
  return value;
}

double number_attribute(hid_t object, const std::string& owner,
                        const char* name) {
  double value = 0;
  read_number(object, owner, name, {H5T_FLOAT, "number"}, H5T_NATIVE_DOUBLE,
              &value);
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

std::vector<std::string> variable_names(hid_t file) {
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
    if (std::string_view(name.data()) != "meta")
      names.emplace_back(name.data());
  }
  return names;
}

H5Id open_hdf5_file(const std::string& path, const std::string& filetype,
                    const std::string& kind, std::uint64_t newest) {
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw Hdf5Error(
        fmt::format("not an HDF5 file; expected a {} of beamgyro", kind));
  H5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access_properties()),
            H5Fclose, "open the file");
  if (H5Aexists(file, "filetype") <= 0 ||
      text_attribute(file, "the file", "filetype") != filetype)
    throw Hdf5Error(fmt::format(
        "not a {} of beamgyro; expected the attribute filetype = \"{}\"", kind,
        filetype));
  const std::uint64_t version = integer_attribute(file, "format_version");
  if (version < 1 || version > newest) {
    throw Hdf5Error(
        fmt::format("format_version {} is not known; this program "
                    "reads up to {}",
                    version, newest));
  }
  return file;
}

void require_file(const std::filesystem::path& path, const std::string& kind) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (error)
    throw std::invalid_argument(
        fmt::format("{}: cannot read: {}", path.string(), error.message()));
  if (!std::filesystem::is_regular_file(status))
    throw std::invalid_argument(fmt::format(
        "{}: not a file; expected a {} of beamgyro", path.string(), kind));
}

}  // namespace beamgyro
