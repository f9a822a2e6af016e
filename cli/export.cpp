// SPDX-License-Identifier: MIT
#include "include/beamgyro/export.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "config/file_error.h"
#include "dataset/files/atomic_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::vector<fs::path> compensators;
  std::string format, output;
  ExportOptions options;
};

// Checks all outputs before the first is written.
void require_outputs(const fs::path& directory,
                     const std::vector<ExportedFile>& texts,
                     const std::vector<fs::path>& inputs) {
  const fs::file_status status = status_of(directory);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw std::invalid_argument(fmt::format(
        "{}: a file; expected a directory that is there or can be made",
        directory.string()));
  for (const auto& [called, text] : texts)
    require_output(directory / called, inputs);
}

int run_export(const ExportArguments& arguments) {
  std::vector<Compensator> compensators;
  for (const fs::path& file : arguments.compensators)
    compensators.push_back(Compensator::read(file));
  const ExportResult result =
      export_files(compensators, arguments.format, arguments.options);
  std::vector<fs::path> inputs = arguments.compensators;
  if (arguments.options.rest) inputs.push_back(*arguments.options.rest);
  require_outputs(arguments.output, result.files, inputs);
  require_directory_name(arguments.output);
  write_exported(arguments.output, result.files);
  for (const std::string& warning : result.warnings) print_warning(warning);
  return 0;
}

}  // namespace

void add_export(CommandLine& program) {
  const auto [command, arguments] = program.add<ExportArguments>(
      "export", kCompensation,
      "Writes a compensator as C source, autopilot parameters or "
      "noise of navigation filters",
      run_export);
  command.list({"COMPENSATOR.json...", "",
                "One compensator; for px4 and ardupilot up to three, one "
                "for each axis"},
               arguments.compensators, 3);
  command.reads({{FileKind::kCompensator}});
  command.choice(
      {"--format", "c|px4|ardupilot|ekf",
       "c writes NAME.h, NAME.c, NAME_selftest.c and NAME_plugin.c; px4 writes "
       "NAME.params; ardupilot writes NAME.parm; ekf writes NAME_ekf.json and "
       "a file for each filter"},
      arguments.format, {"c", "px4", "ardupilot", "ekf"});
  command.text({"-o,--output", "DIR", "Directory to write to"},
               arguments.output);
  command.text({"--name", "NAME", "Name of the files and of the C functions",
                "the file name of the (first) compensator"},
               arguments.options.name);
  command.group("C");
  command.flag({"--force", "",
                "Exports a compensator that cancels the rate, or that single "
                "precision changes by more than 1e-4 deg/s; the code carries a "
                "warning"},
               arguments.options.force);
  command.group("PX4 and ArduPilot");
  command.choices({"--axis", "x|y|z",
                   "Axis of the autopilot's gyro for each compensator, as in "
                   "x,y; of the robot for ekf",
                   "z for one compensator and x,y,z for three"},
                  arguments.options.axes, {"x", "y", "z"});
  command.integer({"--instance", "N",
                   "Number of the autopilot's gyro, 0 to 3 for px4 and 1 to 3 "
                   "for ardupilot",
                   "the first"},
                  arguments.options.instance);
  command.integer({"--device-id", "ID", "px4: identifier of the sensor", "0"},
                  arguments.options.device_id, {0, 2147483647});
  command.flag({"--fit-cubic", "",
                "Exports the cubic fitted to the same rows if the compensator "
                "is no cubic"},
               arguments.options.fit_cubic);
  command.group("Navigation filters (ekf)");
  command.text({"--rest", "RUN.h5",
                "Recording at rest, from which the noise is taken", "none"},
               arguments.options.rest);
  command.reads({{FileKind::kRecording}, {FileKind::kRecordingTable}});
  command.number({"--ramp-K-per-min", "R",
                  "Temperature rate that the bias noise is for", "1"},
                 arguments.options.ramp_K_per_min, {0, 1000});
  command.number({"--correlation-K", "L",
                  "Temperature over which the bias forgets itself", "10"},
                 arguments.options.correlation_K, positive());
  command.number({"--temperature-degC", "T", "Temperature at power-on",
                  "any of the training, equally likely"},
                 arguments.options.temperature_degC, {-273.15, 1000});
  command.example("beamgyro export cubic.json --format c -o firmware",
                  "C source for the firmware of a gyro");
  command.example("beamgyro export x.json y.json z.json --format px4 -o params",
                  "Parameters for three axes");
  command.example(
      "beamgyro export z.json --format ekf --rest rest.h5 -o filters",
      "Noise parameters of navigation filters");
}

}  // namespace beamgyro::internal
