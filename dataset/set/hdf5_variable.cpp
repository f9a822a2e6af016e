// SPDX-License-Identifier: MIT
#include "dataset/set/hdf5_variable.h"

#include <hdf5_hl.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "dataset/hdf5_write.h"
#include "dataset/set/shard_encoding.h"

namespace beamgyro {
namespace {

/// flag_values 0, 1, ... with their meanings.
void write_flags(hid_t variable, std::size_t count, std::string_view meanings) {
  std::vector<std::uint8_t> values(count);
  for (std::size_t k = 0; k < count; ++k)
    values[k] = static_cast<std::uint8_t>(k);
  const hsize_t length = count;
  write_attribute(variable, "flag_values", H5T_STD_U8LE, space_of({&length, 1}),
                  values.data());
  write_text(variable, "flag_meanings", meanings);
}

}  // namespace

hid_t file_type(Storage storage) {
  switch (storage) {
    case Storage::kFloat64:
      return H5T_IEEE_F64LE;
    case Storage::kFloat32:
      return H5T_IEEE_F32LE;
    case Storage::kInt16:
      return H5T_STD_I16LE;
    case Storage::kInt32:
      break;
  }
  return H5T_STD_I32LE;
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
  return variable;
}

void write_scaling(hid_t variable, const SetVariable& about) {
  if (about.storage != Storage::kInt16 && about.storage != Storage::kInt32)
    return;
  const H5Id scalar = scalar_space();
  write_attribute(variable, "scale_factor", H5T_IEEE_F64LE, scalar,
                  &about.scale_factor);
  write_attribute(variable, "add_offset", H5T_IEEE_F64LE, scalar,
                  &about.add_offset);
  write_attribute(variable, "_FillValue", file_type(about.storage), scalar,
                  fill_values(about, 1).data());
}

VariableAbout status_about() {
  return {"status", "1", "state of the gyro", Role::kMeasured};
}

VariableAbout part_about() {
  return {"part", "1", "part of the split", Role::kTruth};
}

VariableAbout device_status_about() {
  return {"device_status", "1", "what became of the device", Role::kTruth};
}

void write_part_flags(hid_t part) {
  write_flags(part, 3, "train validation test");
}

void write_device_status_flags(hid_t device_status) {
  write_flags(device_status, 4,
              "ok invalid_parameters no_convergence not_finite");
}

void write_root_attributes(hid_t file, const ShardHead& head) {
  write_origin(file, kSetFiletype, kSetFormatVersion, head);
  write_text(file, "run", head.run);
}

void write_all(hid_t variable, const std::string& name, hid_t memory_type,
               const void* values) {
  check_hdf5(
      H5Dwrite(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
      "write " + name);
}

}  // namespace beamgyro
