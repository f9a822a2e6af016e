// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "config/document.h"
#include "dataset/files/text_file.h"
#include "dataset/log/log_import.h"
#include "dataset/netcdf/recording_file.h"
#include "report/import_report.h"

namespace beamgyro {
namespace {

struct ImportArguments {
  std::string log, map, output, axis, join;
};

int run_import(const ImportArguments& arguments) {
  require_recording_name(arguments.output);
  const LogMap map =
      read_log_map(ConfigDocument::read(arguments.map), arguments.axis);
  std::vector<std::filesystem::path> inputs = {arguments.log, arguments.map};
  if (!arguments.join.empty()) inputs.emplace_back(arguments.join);
  require_output(arguments.output, inputs);
  std::optional<Progress> progress("importing " + arguments.log);
  const std::string second =
      arguments.join.empty() ? "" : read_text_file(arguments.join);
  std::optional<SecondLog> joined;
  if (!arguments.join.empty()) joined = SecondLog{second, arguments.join};
  ImportedLog log =
      import_log(read_text_file(arguments.log), arguments.log, map, joined);
  Recording& recording = log.recording;
  recording.program_version = kProgramVersion;
  recording.git_revision = kGitRevision;
  recording.title = "imported log of a gyro";
  recording.history = history_line("import");
  if (!arguments.axis.empty())
    recording.overrides_text = fmt::format("axis={}\n", arguments.axis);
  const std::string text = import_report(log, arguments.log, arguments.join);
  write_recording(recording, arguments.output);
  progress.reset();
  print_result(text);
  return 0;
}

}  // namespace

void add_import(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = program.add_subcommand(
      "import", "Convert a log of a real gyro into a recording");
  command
      ->add_option(
          "log", arguments->log,
          "LOG.csv: delimiter-separated text with one sample in each row")
      ->required();
  command
      ->add_option("--map", arguments->map,
                   "MAP.toml, which states what the columns of the log mean")
      ->required();
  command->add_option("-o,--output", arguments->output, "RUN.h5 or RUN.csv")
      ->required();
  command->add_option("--axis", arguments->axis,
                      "x, y or z: which gyro to take if the map has several");
  command->add_option("--join", arguments->join,
                      "LOG.csv: a second log, such as the chamber's, for the "
                      "table [join] of the map");
  command->callback([arguments, &action] {
    action = [arguments] { return run_import(*arguments); };
  });
}

}  // namespace beamgyro
