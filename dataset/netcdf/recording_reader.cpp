// SPDX-License-Identifier: MIT
#include "dataset/netcdf/recording_reader.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "dataset/files/file_checksum.h"
#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_read.h"
#include "dataset/netcdf/hdf5_storage.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

std::size_t number_of_samples(hid_t file,
                              const std::vector<std::string>& names) {
  const H5Id time = open_variable(file, "time");
  const hsize_t samples = lengths_of(time, "time", 1).front();
  const std::uint64_t room = room_for_values(file);
  // What works on a recording has more values of each sample than the file.
  constexpr std::size_t kAtLeast = 16;
  if (samples > room / sizeof(double) / std::max(names.size(), kAtLeast))
    throw Hdf5Error(fmt::format(
        "{} samples of {} variables take more than the {} bytes of memory that "
        "a file of its size may ask for",
        samples, names.size(), room));
  return samples;
}

/// Converts `values` from the unit in the file to that of recordings, if the
/// variable is known.
void convert(const std::string& name, std::string& units,
             std::vector<double>& values) {
  const std::string_view expected = unit_of_variable(name);
  if (expected.empty()) return;
  try {
    const UnitConversion conversion = unit_conversion(units, expected);
    units = expected;
    if (conversion.is_identity()) return;
    for (double& value : values) value = conversion(value);
  } catch (const std::invalid_argument& error) {
    throw Hdf5Error(fmt::format("{}: {}", name, error.what()));
  }
}

std::string units_of(hid_t file, const std::string& name) {
  return text_attribute(open_variable(file, name), name, "units");
}

void read_times(hid_t file, std::size_t samples, Recording& recording) {
  recording.time =
      read_values<double>(file, "time", H5T_FLOAT, H5T_NATIVE_DOUBLE, samples);
  std::string units = units_of(file, "time");
  convert("time", units, recording.time);
  recording.status = read_values<std::uint8_t>(file, "status", H5T_INTEGER,
                                               H5T_NATIVE_UINT8, samples);
  std::vector<double> none;
  units = units_of(file, "status");
  convert("status", units, none);
}

Column read_column(hid_t file, const std::string& name, std::size_t samples) {
  const H5Id variable = open_variable(file, name);
  Column column{
      name, text_attribute(variable, name, "units"),
      text_attribute(variable, name, "long_name"),
      role_of(text_attribute(variable, name, "role"), name),
      read_values<double>(file, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, samples)};
  column.comment = comment_of(variable, name);
  convert(name, column.units, column.values);
  return column;
}

Recording read_file(OpenFile& bytes) {
  const H5Id file = open_hdf5_file(bytes, kRecordingFiletype, "recording",
                                   kRecordingFormatVersion);
  Recording recording;
  recording.program_version =
      text_attribute(file, "the file", "beamgyro_version");
  recording.git_revision = text_attribute(file, "the file", "git_revision");
  recording.fidelity = text_attribute(file, "the file", "fidelity");
  const auto text_if_there = [&](const char* name) {
    return has_attribute(file, "the file", name)
               ? text_attribute(file, "the file", name)
               : std::string();
  };
  recording.title = text_if_there("title");
  recording.history = text_if_there("history");
  recording.compensator = text_if_there("compensator");
  recording.compensator_sha256 = text_if_there("compensator_sha256");
  recording.seed = integer_attribute(file, "seed");
  recording.scenario_text = meta_text(file, "scenario");
  recording.device_text = meta_text(file, "device");
  recording.overrides_text = meta_text(file, "overrides");

  const std::vector<std::string> names = variable_names(file);
  const std::size_t samples = number_of_samples(file, names);
  read_times(file, samples, recording);
  for (const std::string& name : names) {
    if (name == "time" || name == "status") continue;
    recording.columns.push_back(read_column(file, name, samples));
  }
  check_system_calls();
  const std::string defect = recording_defect(recording);
  if (!defect.empty()) throw Hdf5Error(defect);
  return recording;
}

/// Verifies the checksum before HDF5, which may crash on damage, opens the
/// file. Returns whether there is one.
bool check_bytes(const std::filesystem::path& path, OpenFile& file) {
  switch (checksum_of(file)) {
    case FileChecksum::kRight:
      return true;
    case FileChecksum::kWrong:
      throw std::invalid_argument(fmt::format(
          "{}: its checksum is that of other bytes: the file is damaged; "
          "expected it as beamgyro wrote it",
          path.string()));
    case FileChecksum::kNone:
      break;
  }
  if (has_bytes_after_hdf5(file))
    throw std::invalid_argument(fmt::format(
        "{}: ends in bytes that are neither values nor a checksum: the file is "
        "damaged; expected it as beamgyro wrote it",
        path.string()));
  return false;
}

}  // namespace

Recording read_recording(const std::filesystem::path& path,
                         bool* has_checksum) {
  OpenFile file = open_to_read(path, "recording");
  try {
    const bool is_checked = check_bytes(path, file);
    if (has_checksum != nullptr) *has_checksum = is_checked;
    const QuietHdf5 quiet;
    return read_file(file);
  } catch (const Hdf5Error& problem) {
    reject_hdf5_file(path, problem);
  } catch (const std::system_error& error) {
    reject_hdf5_file(path, read_failure(error));
  }
}

}  // namespace beamgyro::internal
