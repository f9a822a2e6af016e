// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_read.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "config/file_error.h"
#include "dataset/files/hdf5_signature.h"
#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_storage.h"

namespace beamgyro::internal {
namespace {

bool is_variable_text(hid_t type) {
  return H5Tget_class(type) == H5T_STRING &&
         is_true(H5Tis_variable_str(type), "read a type");
}

[[noreturn]] void reject_variable_text(const std::string& what) {
  throw Hdf5Error(fmt::format(
      "{} is text of variable length, where damage can crash HDF5; expected "
      "text of fixed length. h5netcdf, h5py and nccopy write the other: copy "
      "with xarray's engine=\"netcdf4\", give h5py numpy.bytes_, or make a "
      "recording as CSV",
      what));
}

/// The text that `read` (H5Aread or H5Dread) fills, of one value of `type`, for
/// which the file has `room` bytes.
template <class Read>
std::string read_string(hid_t type, hid_t space, std::uint64_t room,
                        const std::string& what, const Read& read) {
  if (H5Tget_class(type) != H5T_STRING ||
      H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(what + " is no text");
  if (is_variable_text(type)) reject_variable_text(what);
  const std::size_t size = H5Tget_size(type);
  check_hdf5(size == 0 || size > room ? -1 : 0, "read " + what);
  std::string text(size, '\0');
  check_hdf5(read(text.data()), "read " + what);
  return text.substr(0, text.find('\0'));
}

bool has_link(hid_t file, const std::string& name) {
  return is_true(H5Lexists(file, name.c_str(), H5P_DEFAULT),
                 "look for /" + name);
}

/// Throws unless `name` is the object itself and not a link.
void check_link(hid_t file, const std::string& name, const char* kind) {
  H5L_info_t link{};
  check_hdf5(H5Lget_info(file, name.c_str(), &link, H5P_DEFAULT),
             "open " + name);
  if (link.type != H5L_TYPE_HARD)
    throw Hdf5Error(fmt::format(
        "{} is a link to another place; expected the {} itself", name, kind));
}

/// Throws for a variable of several names, which would be read once for each.
void check_single_name(hid_t variable, const std::string& name) {
  H5O_info_t object{};
  check_hdf5(H5Oget_info2(variable, &object, H5O_INFO_BASIC), "open " + name);
  if (object.rc > 1)
    throw Hdf5Error(fmt::format("{} is a variable of {} names; expected one",
                                name, object.rc));
}

/// Whether `type` is an IEEE number or an integer of `expected` as processors
/// have them: HDF5 converts any other kind by rules that the file makes.
bool is_plain(hid_t type, H5T_class_t expected) {
  const std::array<hid_t, 4> floats = {H5T_IEEE_F64LE, H5T_IEEE_F32LE,
                                       H5T_IEEE_F64BE, H5T_IEEE_F32BE};
  const std::array<hid_t, 14> integers = {
      H5T_STD_U8LE,  H5T_STD_I8LE,  H5T_STD_I16LE, H5T_STD_U16LE, H5T_STD_I32LE,
      H5T_STD_U32LE, H5T_STD_I64LE, H5T_STD_U64LE, H5T_STD_I16BE, H5T_STD_U16BE,
      H5T_STD_I32BE, H5T_STD_U32BE, H5T_STD_I64BE, H5T_STD_U64BE};
  const auto is_one_of = [type](std::span<const hid_t> types) {
    return std::any_of(types.begin(), types.end(), [type](hid_t one) {
      return is_true(H5Tequal(type, one), "compare types");
    });
  };
  return expected == H5T_FLOAT ? is_one_of(floats) : is_one_of(integers);
}

H5Id open_attribute(hid_t object, const std::string& owner, const char* name) {
  if (!has_attribute(object, owner, name))
    throw Hdf5Error(fmt::format("{} has no attribute {}", owner, name));
  return {H5Aopen(object, name, H5P_DEFAULT), H5Aclose,
          fmt::format("open attribute {} of {}", name, owner)};
}

/// A class of types and its name in messages.
struct NumberKind {
  H5T_class_t type_class;
  const char* name;
};

/// One number of `kind` into `value`, which is of `memory_type`.
void read_scalar(hid_t object, const std::string& owner, const char* name,
                 const NumberKind& kind, hid_t memory_type, void* value) {
  const H5Id attribute = open_attribute(object, owner, name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  if (!is_plain(type, kind.type_class) ||
      H5Sget_simple_extent_npoints(space) != 1)
    throw Hdf5Error(
        fmt::format("attribute {} of {} is no {}", name, owner, kind.name));
  check_hdf5(H5Aread(attribute, memory_type, value),
             fmt::format("read attribute {} of {}", name, owner));
}

}  // namespace

H5Id open_variable(hid_t file, const std::string& name) {
  check_link(file, name, "variable");
  take_met_global_heap();
  const hid_t opened = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (opened < 0 && take_met_global_heap()) reject_view(name);
  H5Id variable(opened, H5Dclose, "open " + name);
  check_single_name(variable, name);
  {  // nccopy gives such texts fill values, which no property can be read with
    const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
    if (is_variable_text(type)) reject_variable_text("/" + name);
  }
  check_storage(variable, name);
  return variable;
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
  return lengths;
}

void check_type(hid_t variable, const std::string& name, H5T_class_t expected,
                std::size_t size) {
  const H5Id type(H5Dget_type(variable), H5Tclose, "open " + name);
  if (H5Tget_size(type) <= size && is_plain(type, expected)) return;
  throw Hdf5Error(fmt::format("{} has another type; expected {}", name,
                              expected == H5T_FLOAT ? "floating point"
                              : size == 1           ? "unsigned bytes"
                                                    : "integers"));
}

bool has_attribute(hid_t object, const std::string& owner, const char* name) {
  return is_true(H5Aexists(object, name),
                 fmt::format("look for attribute {} of {}", name, owner));
}

std::string text_attribute(hid_t object, const std::string& owner,
                           const char* name) {
  const H5Id attribute = open_attribute(object, owner, name);
  const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
  const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
  return read_string(
      type, space, H5Aget_storage_size(attribute),
      fmt::format("attribute {} of {}", name, owner),
      [&](void* text) { return H5Aread(attribute, type, text); });
}

std::string comment_of(hid_t object, const std::string& owner) {
  constexpr const char* kCommentName = "comment";
  if (!has_attribute(object, owner, kCommentName)) return {};
  {
    const H5Id attribute = open_attribute(object, owner, kCommentName);
    const H5Id type(H5Aget_type(attribute), H5Tclose, "read a type");
    const H5Id space(H5Aget_space(attribute), H5Sclose, "read a size");
    if (H5Tget_class(type) != H5T_STRING ||
        is_true(H5Tis_variable_str(type), "read a comment") ||
        H5Sget_simple_extent_npoints(space) != 1)
      return {};
  }
  return text_attribute(object, owner, kCommentName);
}

std::uint64_t integer_attribute(hid_t file, const char* name) {
  std::uint64_t value = 0;
  read_scalar(file, "the file", name, {H5T_INTEGER, "integer"},
              H5T_NATIVE_UINT64, &value);
  return value;
}

double number_attribute(hid_t object, const std::string& owner,
                        const char* name) {
  double value = 0;
  read_scalar(object, owner, name, {H5T_FLOAT, "number"}, H5T_NATIVE_DOUBLE,
              &value);
  return value;
}

std::string meta_text(hid_t file, const std::string& name) {
  if (!has_link(file, "meta")) return {};
  check_link(file, "meta", "group");
  if (!has_link(file, "meta/" + name)) return {};
  const H5Id dataset = open_variable(file, "meta/" + name);
  const H5Id type(H5Dget_type(dataset), H5Tclose, "read a type");
  const H5Id space(H5Dget_space(dataset), H5Sclose, "read a size");
  const std::uint64_t room = H5Dget_storage_size(dataset);
  check_chunks_of_row(dataset, "meta/" + name, 0);
  return read_string(type, space, room, "/meta/" + name, [&](void* text) {
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

bool is_of_filetype(hid_t file, const std::string& filetype) {
  return has_attribute(file, "the file", "filetype") &&
         text_attribute(file, "the file", "filetype") == filetype;
}

H5Id open_hdf5_file(OpenFile& bytes, const std::string& filetype,
                    const std::string& kind, std::uint64_t newest) {
  if (!is_hdf5_file(bytes))
    throw Hdf5Error(
        fmt::format("not an HDF5 file; expected a {} of beamgyro", kind));
  H5Id file = open_hdf5_file(bytes);
  if (!is_of_filetype(file, filetype))
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

Hdf5Error read_failure(const std::system_error& error) {
  return Hdf5Error("cannot read: " + error.code().message(),
                   error.code().value());
}

void reject_hdf5_file(const std::filesystem::path& path,
                      const Hdf5Error& problem) {
  const std::string message =
      fmt::format("{}: {}", path.string(), problem.what());
  if (problem.error_number == 0 || problem.error_number == EACCES ||
      problem.error_number == ENOENT)
    throw std::invalid_argument(message);
  throw std::runtime_error(message);
}

OpenFile open_to_read(const std::filesystem::path& path,
                      const std::string& kind) try {
  // Without this flag opening a pipe would wait for its other end.
  OpenFile file(path, O_RDONLY | O_NONBLOCK);
  struct stat facts {};
  if (fstat(file.descriptor(), &facts) != 0)
    throw std::system_error(errno, std::generic_category());
  if (!S_ISREG(facts.st_mode))
    throw std::invalid_argument(fmt::format(
        "{}: not a file; expected a {} of beamgyro", path.string(), kind));
  return file;
} catch (const std::system_error& error) {
  throw_file_error(path, "cannot read", error.code());
}

}  // namespace beamgyro::internal
