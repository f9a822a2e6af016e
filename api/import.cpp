// SPDX-License-Identifier: MIT
#include "include/beamgyro/import.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "api/program_version.h"
#include "config/document.h"
#include "dataset/files/text_file.h"
#include "dataset/log/log_import.h"
#include "report/recording_report.h"

namespace beamgyro {
namespace {

ImportedRecording imported(const std::filesystem::path& log,
                           const internal::LogMap& map,
                           const ImportOptions& options) {
  std::string second;
  std::optional<internal::SecondLog> joined;
  if (!options.join.empty()) {
    second = internal::read_text_file(options.join);
    joined = internal::SecondLog{second, options.join};
  }
  internal::ImportedLog found =
      internal::import_log(internal::read_text_file(log), log, map, joined);
  Recording& recording = found.recording;
  recording.program_version = internal::kProgramVersion;
  recording.git_revision = internal::kGitRevision;
  recording.title = "imported log of a gyro";
  recording.history = internal::history_line("import");
  if (!options.axis.empty())
    recording.overrides_text = fmt::format("axis={}\n", options.axis);
  std::string text =
      internal::import_report(found, log.string(), options.join.string());
  return {std::move(recording), std::move(text)};
}

}  // namespace

ImportedRecording import_log(const std::filesystem::path& log,
                             const std::filesystem::path& map,
                             const ImportOptions& options) {
  return imported(
      log,
      internal::read_log_map(internal::ConfigDocument::read(map), options.axis),
      options);
}

ImportedRecording import_log(const std::filesystem::path& log,
                             const std::string& map_text,
                             const std::string& name,
                             const ImportOptions& options) {
  return imported(
      log,
      internal::read_log_map(internal::ConfigDocument::parse(map_text, name),
                             options.axis),
      options);
}

}  // namespace beamgyro
