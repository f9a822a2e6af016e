// SPDX-License-Identifier: MIT
#include "include/beamgyro/export.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/terminal.h"
#include "config/file_error.h"
#include "config/option_message.h"
#include "dataset/files/atomic_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::vector<fs::path> inputs;
  std::string format, output, range;
  ExportOptions options;
  std::optional<double> update_rate_Hz;
};

constexpr const char* kSitl = "ardupilot-sitl";
constexpr const char* kSdf = "sdf";

bool is_for_simulator(const ExportArguments& arguments) {
  return arguments.format == kSitl || arguments.format == kSdf;
}

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

// Options of other formats, by their names and what asks for them.
void require_simulator_options(const ExportArguments& arguments) {
  const ExportOptions& o = arguments.options;
  const std::pair<bool, const char*> others[] = {
      {o.device_id.has_value(), "device_id"},
      {o.force, "force"},
      {o.rest.has_value(), "rest"},
      {o.ramp_K_per_min.has_value(), "ramp_K_per_min"},
      {o.correlation_K.has_value(), "correlation_K"}};
  for (const auto& [given, option] : others)
    if (given)
      throw option_error("{}: is not for the format {}", NamedOption{option},
                         arguments.format);
}

void require_compensators(const ExportArguments& arguments) {
  const std::pair<bool, const char*> others[] = {
      {!arguments.range.empty(), "range"},
      {arguments.update_rate_Hz.has_value(), "update_rate_Hz"}};
  for (const auto& [given, option] : others)
    if (given)
      throw option_error(
          "{}: is for the format {}, not for {}", NamedOption{option},
          std::string_view(option) == "range" ? kSitl : kSdf, arguments.format);
  constexpr std::size_t kMost = 3;  // one for each axis
  if (arguments.inputs.size() > kMost)
    throw std::invalid_argument(fmt::format(
        "\"{}\" is one file too many for the format {}; expected beamgyro "
        "export of up to {} compensators",
        arguments.inputs[kMost].string(), arguments.format, kMost));
  for (const fs::path& file : arguments.inputs)
    if (is_of_kind(file, FileKind::kDevice))
      throw std::invalid_argument(fmt::format(
          "{}: is a device file; the format {} is of compensators; beamgyro "
          "characterise and the formats {} and {} are for a device file",
          file.string(), arguments.format, kSitl, kSdf));
}

ExportResult simulator_files(const ExportArguments& arguments) {
  require_simulator_options(arguments);
  std::vector<Device> devices;
  std::vector<Compensator> compensators;
  for (const fs::path& file : arguments.inputs)
    if (is_of_kind(file, FileKind::kCompensator))
      compensators.push_back(Compensator::read(file));
    else
      devices.push_back(Device::read(file));
  SimulatorExportOptions options{
      .name = arguments.options.name,
      .axes = arguments.options.axes,
      .fit_cubic = arguments.options.fit_cubic,
      .instance = arguments.options.instance,
      .temperature_degC = arguments.options.temperature_degC,
      .update_rate_Hz = arguments.update_rate_Hz};
  if (!arguments.range.empty())
    options.range_degC = temperature_range("--range", arguments.range);
  return export_for_simulator(devices, compensators, arguments.format, options);
}

ExportResult compensator_files(const ExportArguments& arguments) {
  require_compensators(arguments);
  std::vector<Compensator> compensators;
  for (const fs::path& file : arguments.inputs)
    compensators.push_back(Compensator::read(file));
  return export_files(compensators, arguments.format, arguments.options);
}

int run_export(const ExportArguments& arguments) {
  const ExportResult result = is_for_simulator(arguments)
                                  ? simulator_files(arguments)
                                  : compensator_files(arguments);
  std::vector<fs::path> inputs = arguments.inputs;
  if (arguments.options.rest) inputs.push_back(*arguments.options.rest);
  require_outputs(arguments.output, result.files, inputs);
  require_directory_name(arguments.output);
  write_exported(arguments.output, result.files);
  for (const std::string& remark : result.remarks)
    if (!is_quiet()) print_result(remark + '\n');
  for (const std::string& warning : result.warnings) print_warning(warning);
  return 0;
}

}  // namespace

void add_export(CommandLine& program) {
  const auto [command, arguments] = program.add<ExportArguments>(
      "export", kCompensation,
      "Writes compensators for firmware, autopilots and navigation filters, "
      "devices for simulators",
      run_export);
  command.list({"COMPENSATOR.json|DEVICE.toml...", "",
                "One compensator; for px4 and ardupilot up to three, one "
                "for each axis; for ardupilot-sitl up to three devices, "
                "compensators or both; for sdf one device"},
               arguments.inputs, 6);
  command.reads({{FileKind::kCompensator, FileKind::kDevice}});
  command.choice(
      {"--format", "c|px4|ardupilot|ekf|ardupilot-sitl|sdf",
       "c writes NAME.h, NAME.c, NAME_selftest.c and NAME_plugin.c; px4 writes "
       "NAME.params; ardupilot writes NAME.parm; ekf writes NAME_ekf.json and "
       "a file for each filter; ardupilot-sitl writes NAME_sitl.parm and "
       "NAME.parm; sdf writes NAME.sdf"},
      arguments.format, {"c", "px4", "ardupilot", "ekf", kSitl, kSdf});
  command.text({"-o,--output", "DIR", "Directory to write to"},
               arguments.output);
  command.text({"--name", "NAME", "Name of the files and of the C functions",
                "the file name of the first device or compensator"},
               arguments.options.name);
  command.group("C");
  command.flag({"--force", "",
                "Exports a compensator that cancels the rate, or that single "
                "precision changes by more than 1e-4 deg/s; the code carries a "
                "warning"},
               arguments.options.force);
  command.group("PX4 and ArduPilot");
  command.choices({"--axis", "x|y|z",
                   "Axis of the autopilot's gyro for each compensator or "
                   "device, as in x,y; of the robot for ekf and sdf",
                   "z for one compensator and x,y,z for three"},
                  arguments.options.axes, {"x", "y", "z"});
  command.integer({"--instance", "N",
                   "Number of the autopilot's gyro, 0 to 3 for px4 and 1 to 3 "
                   "for ardupilot and ardupilot-sitl",
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
  command.number({"--temperature-degC", "T",
                  "Temperature at power-on; of still air for simulators",
                  "ekf: any of the training, equally likely; else 25"},
                 arguments.options.temperature_degC, {-273.15, 1000});
  command.group("Simulators (ardupilot-sitl, sdf)");
  command.text({"--range", "LOW:HIGH",
                "ardupilot-sitl: temperatures of the chamber in which the "
                "device is swept, in degC",
                "-40:50"},
               arguments.range);
  command.number(
      {"--update-rate-Hz", "F", "sdf: rate of the simulated sensor", "100"},
      arguments.update_rate_Hz, {0, 1e5, true, true});
  command.example("beamgyro export cubic.json --format c -o firmware",
                  "C source for the firmware of a gyro");
  command.example("beamgyro export x.json y.json z.json --format px4 -o params",
                  "Parameters for three axes");
  command.example(
      "beamgyro export z.json --format ekf --rest rest.h5 -o filters",
      "Noise parameters of navigation filters");
  command.example(
      "beamgyro export scenarios/devices/nominal.toml --format ardupilot-sitl "
      "-o sitl",
      "Drift and warm-up of a device for ArduPilot's simulator");
}

}  // namespace beamgyro::internal
