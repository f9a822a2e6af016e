// SPDX-License-Identifier: MIT
#include "include/beamgyro/import.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

struct ImportArguments {
  std::string log, map, output, axis, join;
};

int run_import(const ImportArguments& arguments) {
  require_recording_name(arguments.output);
  std::vector<std::filesystem::path> inputs = {arguments.log, arguments.map};
  if (!arguments.join.empty()) inputs.emplace_back(arguments.join);
  require_output(arguments.output, inputs);
  std::optional<Progress> progress("importing " + arguments.log);
  const ImportedRecording imported =
      beamgyro::import_log(arguments.log, arguments.map,
                           {.axis = arguments.axis, .join = arguments.join});
  write_recording(imported.recording, arguments.output);
  progress.reset();
  print_result(imported.text);
  return 0;
}

}  // namespace

void add_import(CommandLine& program) {
  const auto [command, arguments] = program.add<ImportArguments>(
      "import", kFiles, "Converts a log of a real gyro into a recording",
      run_import);
  command.text(
      {"LOG.csv", "", "Delimiter-separated text with one sample in each row"},
      arguments.log);
  command.reads({{FileKind::kLog},
                 {FileKind::kRecordingTable, FileKind::kCharacteristic,
                  FileKind::kProfile}});
  command.text({"--map", "MAP.toml", "States what the columns of the log mean"},
               arguments.map);
  command.reads({{FileKind::kLogMap}});
  command.text({"-o,--output", "RUN.h5", "Recording to write, .h5 or .csv"},
               arguments.output);
  command.text(
      {"--axis", "AXIS", "x, y or z: which gyro to take if the map has several",
       "the only one"},
      arguments.axis);
  command.text({"--join", "SECOND.csv",
                "A second log, such as the chamber's, for the table [join] of "
                "the map",
                "no second log"},
               arguments.join);
  command.example(
      "beamgyro import log.csv --map scenarios/maps/example.toml -o log.h5",
      "A log with the columns that the map names");
}

}  // namespace beamgyro::internal
