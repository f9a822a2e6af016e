// SPDX-License-Identifier: MIT
#include "dataset/set/shard/shard_layout.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "dataset/set/shard/shard_encoding.h"

namespace beamgyro::internal {
namespace {

/// flag_values 0, 1, ... with their meanings.
void write_values(hid_t variable, std::uint8_t count,
                  std::string_view meanings) {
  std::vector<std::uint8_t> values;
  for (std::uint8_t k = 0; k < count; ++k) values.push_back(k);
  write_flags(variable, "flag_values", values, meanings);
}

}  // namespace

H5Id make_image() {
  constexpr std::size_t kIncrement = std::size_t{1} << 20;  // [byte]
  const H5Id access = access_properties();
  check_hdf5(H5Pset_fapl_core(access, kIncrement, false), "stay in memory");
  // HDF5 looks for a file of this name first, and tells open files apart by it.
  static std::atomic<std::uint64_t> count{0};
  const std::string name = fmt::format("/dev/null/image-{}", count++);
  return {H5Fcreate(name.c_str(), H5F_ACC_TRUNC,
                    creation_properties(H5P_FILE_CREATE), access),
          H5Fclose, "create the file"};
}

std::span<const std::byte> image_bytes(const H5Id& file) {
  check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), "complete the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check_hdf5(size < 0 ? -1 : 0, "size the file");
  void* handle = nullptr;
  check_hdf5(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle), "find the file");
  return {*static_cast<const std::byte* const*>(handle),
          static_cast<std::size_t>(size)};
}

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

VariableAbout part_about() {
  return {"part", "1", "part of the split", Role::kTruth};
}

VariableAbout device_status_about() {
  return {"device_status", "1", "what became of the device", Role::kTruth};
}

void write_part_flags(hid_t part) {
  write_values(part, 3, "train validation test");
}

void write_device_status_flags(hid_t device_status) {
  write_values(device_status, 4,
               "ok invalid_parameters no_convergence not_finite");
}

void write_root_attributes(hid_t file, const ShardHead& head) {
  write_origin(file, kSetFiletype, kSetFormatVersion, head);
  write_text(file, "run", head.run);
  write_text(file, "title",
             fmt::format("run {} of a set of virtual gyros", head.run));
  write_text(file, "history",
             fmt::format("beamgyro {} ({}): generate", head.program_version,
                         head.git_revision));
  // Readers make coordinates of the variables that are named here.
  std::string coordinates = "part device_status";
  for (const DeviceVariable& parameter : head.parameters)
    coordinates += ' ' + parameter.name;
  write_text(file, "coordinates", coordinates);
}

void write_all(hid_t variable, const std::string& name, hid_t memory_type,
               const void* values) {
  check_hdf5(
      H5Dwrite(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
      "write " + name);
}

}  // namespace beamgyro::internal
