// SPDX-License-Identifier: MIT
#include "dataset/netcdf/recording_layout.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_write.h"
#include "dataset/netcdf/recording_layout.h"
#include "dataset/netcdf/recording_reader.h"

namespace beamgyro::internal {
namespace {

/// Makes variables over one time axis, contiguous and without their values:
/// deflate would be the slowest part of a run by far.
class VariableMaker {
 public:
  VariableMaker(hid_t file, hsize_t length)
      : file_(file),
        space_(space_of({&length, 1})),
        properties_(creation_properties(H5P_DATASET_CREATE)) {
    check_hdf5(H5Pset_alloc_time(properties_, H5D_ALLOC_TIME_EARLY),
               "place values");
    check_hdf5(H5Pset_fill_time(properties_, H5D_FILL_TIME_NEVER),
               "leave values open");
  }

  /// Without `time` the variable becomes the time axis itself.
  H5Id make(const VariableAbout& about, hid_t type, const H5Id* time) const {
    const std::span<const H5Id* const> axes(&time, time == nullptr ? 0 : 1);
    return make_variable(file_, about, type, space_, properties_, axes);
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
  H5Id status = maker.make(status_about(), H5T_STD_U8LE, &time);
  write_status_bits(status);
  return status;
}

Hdf5Layout make_variables(hid_t file, const Recording& head,
                          std::size_t samples) {
  const VariableMaker maker(file, samples);
  H5Id time = maker.make({"time", "s", "time"}, H5T_IEEE_F64LE, nullptr);
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
    H5Id variable = maker.make({column.name, column.units, column.long_name,
                                column.role, column.comment},
                               H5T_IEEE_F64LE, &time);
    layout.columns.push_back(place_of(variable, column.name));
    variable.close("write " + column.name);
  }
  time.close("write time");
  return layout;
}

Hdf5Layout make_file(const Recording& head, std::size_t samples,
                     OpenFile& bytes) {
  H5Id file = create_hdf5_file(bytes);
  write_origin(file, kRecordingFiletype, kRecordingFormatVersion, head);
  const std::array<NamedText, 4> about = {
      {{"title", head.title},
       {"history", head.history},
       {"compensator", head.compensator},
       {"compensator_sha256", head.compensator_sha256}}};
  for (const NamedText& text : about)
    if (!text.text.empty()) write_text(file, text.name, text.text);
  Hdf5Layout layout = make_variables(file, head, samples);
  const std::array<NamedText, 3> texts = {{{"scenario", head.scenario_text},
                                           {"device", head.device_text},
                                           {"overrides", head.overrides_text}}};
  write_meta(file, texts);
  file.close("close the file");
  check_system_calls();
  return layout;
}

}  // namespace

Hdf5Layout make_hdf5_file(const Recording& head, std::size_t samples,
                          OpenFile& file) {
  const QuietHdf5 quiet;
  return make_file(head, samples, file);
}

}  // namespace beamgyro::internal
