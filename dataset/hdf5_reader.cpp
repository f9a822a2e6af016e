// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset/hdf5_file.h"
#include "dataset/hdf5_id.h"
#include "dataset/hdf5_read.h"
#include "dataset/recording_defect.h"

namespace beamgyro {
namespace {

Recording read_file(const std::string& name) {
  const H5Id file = open_hdf5_file(name, kRecordingFiletype, "recording",
                                   kRecordingFormatVersion);
  Recording recording;
  recording.program_version =
      text_attribute(file, "the file", "beamgyro_version");
  recording.git_revision = text_attribute(file, "the file", "git_revision");
  recording.fidelity = text_attribute(file, "the file", "fidelity");
  recording.seed = integer_attribute(file, "seed");
  recording.scenario_text = meta_text(file, "scenario");
  recording.device_text = meta_text(file, "device");
  recording.overrides_text = meta_text(file, "overrides");

  recording.time =
      read_values<double>(file, "time", H5T_FLOAT, H5T_NATIVE_DOUBLE, 0);
  const std::size_t times = recording.time.size();
  recording.status = read_values<std::uint8_t>(file, "status", H5T_INTEGER,
                                               H5T_NATIVE_UINT8, times);
  for (const std::string& column : variable_names(file)) {
    if (column == "time" || column == "status") continue;
    const H5Id variable = open_variable(file, column);
    recording.columns.push_back(
        {column, text_attribute(variable, column, "units"),
         text_attribute(variable, column, "long_name"),
         role_of(text_attribute(variable, column, "role"), column),
         read_values<double>(file, column, H5T_FLOAT, H5T_NATIVE_DOUBLE,
                             times)});
  }
  const std::string defect = recording_defect(recording);
  if (!defect.empty()) throw Hdf5Error(defect);
  return recording;
}

}  // namespace

Recording read_recording(const std::filesystem::path& path) {
  require_file(path, "recording");
  const QuietHdf5 quiet;
  try {
    return read_file(path.string());
  } catch (const Hdf5Error& problem) {
    throw std::invalid_argument(
        fmt::format("{}: {}", path.string(), problem.what()));
  }
}

}  // namespace beamgyro
