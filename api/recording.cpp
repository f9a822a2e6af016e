// SPDX-License-Identifier: MIT
#include "include/beamgyro/recording.h"

#include <fmt/format.h>

#include "api/program_version.h"
#include "dataset/files/file_ending.h"
#include "dataset/files/text_file.h"
#include "dataset/log/recording_csv.h"
#include "dataset/netcdf/recording_reader.h"

namespace beamgyro {
namespace {

Recording recording_of_csv(const std::filesystem::path& path) {
  Recording read =
      internal::parse_recording_csv(internal::read_text_file(path), path);
  read.program_version = internal::kProgramVersion;
  read.git_revision = internal::kGitRevision;
  return read;
}

}  // namespace

Recording read_recording(const std::filesystem::path& path,
                         std::vector<std::string>* warnings) {
  if (internal::file_ending(path) == ".csv") return recording_of_csv(path);
  bool has_checksum = false;
  Recording recording = internal::read_recording(path, &has_checksum);
  if (!has_checksum && warnings != nullptr)
    warnings->push_back(fmt::format(
        "{}: has no checksum, since another program made or changed it: damage "
        "in it would not be noticed",
        path.string()));
  return recording;
}

}  // namespace beamgyro
