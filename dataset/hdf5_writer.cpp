// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "dataset/atomic_file.h"
#include "dataset/hdf5_file.h"
#include "dataset/hdf5_id.h"
#include "dataset/recording_defect.h"

namespace beamgyro {
namespace {

H5Id scalar_space() {
  return {H5Screate(H5S_SCALAR), H5Sclose, "create a scalar"};
}

constexpr unsigned kCreationOrder =
    H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

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
  const H5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "copy a type");
  // No HDF5 type has size 0: an empty text is one NUL, which padding is too.
  check_hdf5(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)),
             "size text");
  check_hdf5(H5Tset_strpad(type, H5T_STR_NULLPAD), "pad text");
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), "choose UTF-8");
  write_attribute(object, name, type, scalar_space(),
                  text.empty() ? "" : text.data());
}

void write_meta(hid_t file, const Recording& recording) {
  const H5Id create = property_list(H5P_GROUP_CREATE);
  check_hdf5(H5Pset_obj_track_times(create, false), "switch off time stamps");
  check_hdf5(H5Pset_link_creation_order(create, kCreationOrder), "order /meta");
  H5Id group(H5Gcreate2(file, "meta", H5P_DEFAULT, create, H5P_DEFAULT),
             H5Gclose, "create /meta");
  const H5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "copy a type");
  check_hdf5(H5Tset_size(type, H5T_VARIABLE), "size text");
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), "choose UTF-8");
  const H5Id properties = property_list(H5P_DATASET_CREATE);
  check_hdf5(H5Pset_obj_track_times(properties, false),
             "switch off time stamps");
  for (const auto& [name, text] :
       {std::pair{"scenario", &recording.scenario_text},
        std::pair{"device", &recording.device_text},
        std::pair{"overrides", &recording.overrides_text}}) {
    const std::string action = fmt::format("write /meta/{}", name);
    H5Id dataset(H5Dcreate2(group, name, type, scalar_space(), H5P_DEFAULT,
                            properties, H5P_DEFAULT),
                 H5Dclose, action);
    const char* bytes = text->c_str();
    check_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &bytes),
               action);
    dataset.close(action);
  }
  group.close("close /meta");
}

/// Writes variables over one time axis, contiguous: deflate would be the
/// slowest part of a run by far.
class VariableWriter {
 public:
  VariableWriter(hid_t file, hsize_t length)
      : file_(file),
        space_(H5Screate_simple(1, &length, nullptr), H5Sclose,
               "create a dimension"),
        properties_(property_list(H5P_DATASET_CREATE)) {
    check_hdf5(H5Pset_obj_track_times(properties_, false),
               "switch off time stamps");
    check_hdf5(H5Pset_attr_creation_order(properties_, kCreationOrder),
               "order attributes");
  }

  /// Without `time` the variable becomes the time axis itself.
  H5Id write(const Column& about, hid_t type, hid_t memory_type,
             const void* values, const H5Id* time) const {
    const std::string action = "write " + about.name;
    H5Id variable(H5Dcreate2(file_, about.name.c_str(), type, space_,
                             H5P_DEFAULT, properties_, H5P_DEFAULT),
                  H5Dclose, action);
    if (time == nullptr) {
      check_hdf5(H5DSset_scale(variable, about.name.c_str()), action);
    } else {
      check_hdf5(H5DSattach_scale(variable, *time, 0), action);
    }
    write_text(variable, "units", about.units);
    write_text(variable, "long_name", about.long_name);
    write_text(variable, "role", role_name(about.role));
    check_hdf5(
        H5Dwrite(variable, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
        action);
    return variable;
  }

 private:
  hid_t file_;
  H5Id space_, properties_;
};

void write_status(const VariableWriter& writer, const Recording& recording,
                  const H5Id& time) {
  H5Id status = writer.write(
      {"status", "1", "state of the gyro", Role::kMeasured, {}}, H5T_STD_U8LE,
      H5T_NATIVE_UINT8, recording.status.data(), &time);
  constexpr std::array<std::uint8_t, 3> kMasks = {kUnpowered, kOutputSaturated,
                                                  kLoopNotLocked};
  const hsize_t count = kMasks.size();
  const H5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose,
                   "create a dimension");
  write_attribute(status, "flag_masks", H5T_STD_U8LE, space, kMasks.data());
  write_text(status, "flag_meanings",
             "unpowered output_saturated loop_not_locked");
  status.close("write status");
}

void write_variables(hid_t file, const Recording& recording) {
  const VariableWriter writer(file, recording.time.size());
  H5Id time =
      writer.write({"time", "s", "time", Role::kMeasured, {}}, H5T_IEEE_F64LE,
                   H5T_NATIVE_DOUBLE, recording.time.data(), nullptr);
  const std::size_t status_at = status_position(recording);
  for (std::size_t i = 0; i <= recording.columns.size(); ++i) {
    if (i == status_at) write_status(writer, recording, time);
    if (i == recording.columns.size()) break;
    const Column& column = recording.columns[i];
    H5Id variable = writer.write(column, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                 column.values.data(), &time);
    variable.close("write " + column.name);
  }
  time.close("write time");
}

/// The bytes of the open file `id`.
std::string image_of(hid_t id) {
  const ssize_t size = H5Fget_file_image(id, nullptr, 0);
  check_hdf5(size < 0 ? -1 : 0, "size the file");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  check_hdf5(H5Fget_file_image(id, bytes.data(), bytes.size()) < 0 ? -1 : 0,
             "copy the file");
  return bytes;
}

/// The whole file, made in memory: HDF5 1.10 never sees a disk that fails,
/// after which it would crash at the end of the process.
std::string file_image(const Recording& recording) {
  const H5Id create = property_list(H5P_FILE_CREATE);
  check_hdf5(H5Pset_link_creation_order(create, kCreationOrder),
             "order variables");
  check_hdf5(H5Pset_attr_creation_order(create, kCreationOrder),
             "order attributes");
  check_hdf5(H5Pset_obj_track_times(create, false), "switch off time stamps");
  const H5Id access = access_properties();
  constexpr std::size_t kGrowth = std::size_t{4} << 20;  // [bytes]
  check_hdf5(H5Pset_fapl_core(access, kGrowth, false), "work in memory");
  // HDF5 tells files in memory apart by their name.
  static std::atomic<unsigned long> count = 0;
  const std::string name = fmt::format("recording {}", ++count);
  H5Id file(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, create, access), H5Fclose,
            "create the file");
  write_text(file, "Conventions", "CF-1.10");
  write_text(file, "filetype", kRecordingFiletype);
  const std::int32_t version = kRecordingFormatVersion;
  write_attribute(file, "format_version", H5T_STD_I32LE, scalar_space(),
                  &version);
  write_text(file, "beamgyro_version", recording.program_version);
  write_text(file, "git_revision", recording.git_revision);
  write_attribute(file, "seed", H5T_STD_U64LE, scalar_space(), &recording.seed);
  write_text(file, "fidelity", recording.fidelity);
  write_variables(file, recording);
  write_meta(file, recording);
  check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), "write the file");
  std::string bytes = image_of(file);
  file.close("close the file");
  return bytes;
}

}  // namespace

void write_recording(const Recording& recording,
                     const std::filesystem::path& path) {
  const std::string defect = recording_defect(recording);
  if (!defect.empty()) {
    throw std::runtime_error(
        fmt::format("{}: not written: {}", path.string(), defect));
  }
  std::string bytes;
  const QuietHdf5 quiet;
  try {
    bytes = file_image(recording);
  } catch (const Hdf5Error& error) {
    throw std::runtime_error(
        fmt::format("{}: {}", path.string(), error.what()));
  }
  write_text_file(path, bytes);
}

}  // namespace beamgyro
