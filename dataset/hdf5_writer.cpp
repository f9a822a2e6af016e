// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "dataset/hdf5_file.h"
#include "dataset/hdf5_id.h"
#include "dataset/hdf5_layout.h"

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

/// Makes variables over one time axis, contiguous and without their values:
/// deflate would be the slowest part of a run by far.
class VariableMaker {
 public:
  VariableMaker(hid_t file, hsize_t length)
      : file_(file),
        space_(H5Screate_simple(1, &length, nullptr), H5Sclose,
               "create a dimension"),
        properties_(property_list(H5P_DATASET_CREATE)) {
    check_hdf5(H5Pset_obj_track_times(properties_, false),
               "switch off time stamps");
    check_hdf5(H5Pset_attr_creation_order(properties_, kCreationOrder),
               "order attributes");
    check_hdf5(H5Pset_alloc_time(properties_, H5D_ALLOC_TIME_EARLY),
               "place values");
    check_hdf5(H5Pset_fill_time(properties_, H5D_FILL_TIME_NEVER),
               "leave values open");
  }

  /// Without `time` the variable becomes the time axis itself.
  H5Id make(const Column& about, hid_t type, const H5Id* time) const {
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
    return variable;
  }

 private:
  hid_t file_;
  H5Id space_, properties_;
};

std::uint64_t place_of(const H5Id& variable, const std::string& name) {
  const haddr_t place = H5Dget_offset(variable);
  check_hdf5(place == HADDR_UNDEF ? -1 : 0, "place " + name);
  return place;
}

H5Id make_status(const VariableMaker& maker, const H5Id& time) {
  H5Id status =
      maker.make({"status", "1", "state of the gyro", Role::kMeasured, {}},
                 H5T_STD_U8LE, &time);
  constexpr std::array<std::uint8_t, 3> kMasks = {kUnpowered, kOutputSaturated,
                                                  kLoopNotLocked};
  const hsize_t count = kMasks.size();
  const H5Id space(H5Screate_simple(1, &count, nullptr), H5Sclose,
                   "create a dimension");
  write_attribute(status, "flag_masks", H5T_STD_U8LE, space, kMasks.data());
  write_text(status, "flag_meanings",
             "unpowered output_saturated loop_not_locked");
  return status;
}

Hdf5Layout make_variables(hid_t file, const Recording& head,
                          std::size_t samples) {
  const VariableMaker maker(file, samples);
  H5Id time = maker.make({"time", "s", "time", Role::kMeasured, {}},
                         H5T_IEEE_F64LE, nullptr);
  Hdf5Layout layout;
  layout.time = place_of(time, "time");
  const std::size_t status_at = status_position(head);
  for (std::size_t i = 0; i <= head.columns.size(); ++i) {
    if (i == status_at) {
      H5Id status = make_status(maker, time);
      layout.status = place_of(status, "status");
      status.close("write status");
    }
    if (i == head.columns.size()) break;
    const Column& column = head.columns[i];
    H5Id variable = maker.make(column, H5T_IEEE_F64LE, &time);
    layout.columns.push_back(place_of(variable, column.name));
    variable.close("write " + column.name);
  }
  time.close("write time");
  return layout;
}

Hdf5Layout make_file(const Recording& head, std::size_t samples,
                     const std::filesystem::path& path) {
  const H5Id create = property_list(H5P_FILE_CREATE);
  check_hdf5(H5Pset_link_creation_order(create, kCreationOrder),
             "order variables");
  check_hdf5(H5Pset_attr_creation_order(create, kCreationOrder),
             "order attributes");
  check_hdf5(H5Pset_obj_track_times(create, false), "switch off time stamps");
  H5Id file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create, access_properties()),
            H5Fclose, "create the file");
  write_text(file, "Conventions", "CF-1.10");
  write_text(file, "filetype", kRecordingFiletype);
  const std::int32_t version = kRecordingFormatVersion;
  write_attribute(file, "format_version", H5T_STD_I32LE, scalar_space(),
                  &version);
  write_text(file, "beamgyro_version", head.program_version);
  write_text(file, "git_revision", head.git_revision);
  write_attribute(file, "seed", H5T_STD_U64LE, scalar_space(), &head.seed);
  write_text(file, "fidelity", head.fidelity);
  Hdf5Layout layout = make_variables(file, head, samples);
  write_meta(file, head);
  file.close("close the file");
  return layout;
}

}  // namespace

Hdf5Layout make_hdf5_file(const Recording& head, std::size_t samples,
                          const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  return make_file(head, samples, path);
}

}  // namespace beamgyro
