// SPDX-License-Identifier: MIT
#include "dataset/netcdf/hdf5_write.h"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace beamgyro::internal {
namespace {

H5Id text_type(std::size_t size, H5T_str_t padding) {
  H5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "copy a type");
  check_hdf5(H5Tset_size(type, size), "size text");
  check_hdf5(H5Tset_strpad(type, padding), "pad text");
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), "choose UTF-8");
  return type;
}

}  // namespace

H5Id scalar_space() {
  return {H5Screate(H5S_SCALAR), H5Sclose, "create a scalar"};
}

H5Id creation_properties(hid_t kind) {
  constexpr unsigned kInOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  H5Id properties = property_list(kind);
  check_hdf5(H5Pset_obj_track_times(properties, false),
             "switch off time stamps");
  check_hdf5(H5Pset_attr_creation_order(properties, kInOrder),
             "order attributes");
  // Attributes stay in the header of their object. HDF5 1.10 cannot delete one
  // that it moved to a B-tree and opened again.
  constexpr unsigned kMostInHeader = 64;
  check_hdf5(H5Pset_attr_phase_change(properties, kMostInHeader, 0),
             "place attributes");
  if (kind != H5P_DATASET_CREATE) {
    check_hdf5(H5Pset_link_creation_order(properties, kInOrder),
               "order variables");
  }
  return properties;
}

void write_attribute(hid_t object, const char* name, hid_t type, hid_t space,
                     const void* value) {
  const std::string action = fmt::format("write attribute {}", name);
  H5Id attribute(
      H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      action);
  check_hdf5(H5Awrite(attribute, type, value), action);
  attribute.close(action);
}

void write_text(hid_t object, const char* name, std::string_view text) {
  // No HDF5 type has size 0: an empty text is one NUL, which padding is too.
  const H5Id type =
      text_type(std::max<std::size_t>(text.size(), 1), H5T_STR_NULLPAD);
  write_attribute(object, name, type, scalar_space(),
                  text.empty() ? "" : text.data());
}

void write_flags(hid_t variable, const char* attribute,
                 std::span<const std::uint8_t> flags,
                 std::string_view meanings) {
  const hsize_t length = flags.size();
  write_attribute(variable, attribute, H5T_STD_U8LE, space_of({&length, 1}),
                  flags.data());
  write_text(variable, "flag_meanings", meanings);
}

H5Id space_of(std::span<const hsize_t> lengths) {
  return {H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(),
                           nullptr),
          H5Sclose, "create dimensions"};
}

H5Id make_variable(hid_t file, const VariableAbout& about, hid_t type,
                   hid_t space, hid_t properties,
                   std::span<const H5Id* const> axes) {
  const std::string action = "write " + about.name;
  H5Id variable(H5Dcreate2(file, about.name.c_str(), type, space, H5P_DEFAULT,
                           properties, H5P_DEFAULT),
                H5Dclose, action);
  if (axes.empty())
    check_hdf5(H5DSset_scale(variable, about.name.c_str()), action);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    check_hdf5(H5DSattach_scale(variable, *axes[i], static_cast<unsigned>(i)),
               action);
  }
  write_text(variable, "units", about.units);
  write_text(variable, "long_name", about.long_name);
  write_text(variable, "role", role_name(about.role));
  if (!about.comment.empty()) write_text(variable, "comment", about.comment);
  const std::string_view standard_name = standard_name_of(about.name);
  if (!standard_name.empty())
    write_text(variable, "standard_name", standard_name);
  if (axes.empty() && standard_name == "time")
    write_text(variable, "axis", "T");
  return variable;
}

void write_status_bits(hid_t status) {
  write_flags(status, "flag_masks", kStatusMasks, kStatusMeanings);
}

void write_meta(hid_t file, std::span<const NamedText> texts) {
  H5Id group(H5Gcreate2(file, "meta", H5P_DEFAULT,
                        creation_properties(H5P_GROUP_CREATE), H5P_DEFAULT),
             H5Gclose, "create /meta");
  const H5Id properties = creation_properties(H5P_DATASET_CREATE);
  for (const NamedText& entry : texts) {
    const std::string action = fmt::format("write /meta/{}", entry.name);
    // netCDF reads up to a NUL, and takes a single byte for no text.
    std::string text(entry.text);
    text.resize(std::max<std::size_t>(text.size() + 1, 2));
    const H5Id type = text_type(text.size(), H5T_STR_NULLTERM);
    H5Id dataset(H5Dcreate2(group, entry.name, type, scalar_space(),
                            H5P_DEFAULT, properties, H5P_DEFAULT),
                 H5Dclose, action);
    check_hdf5(
        H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()),
        action);
    dataset.close(action);
  }
  group.close("close /meta");
}

}  // namespace beamgyro::internal
