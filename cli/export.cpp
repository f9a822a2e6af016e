// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/export/export_c.h"
#include "compensation/export/export_ekf.h"
#include "compensation/export/export_parameters.h"
#include "compensation/firmware/c_text.h"
#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/made_directories.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::vector<std::string> compensators, axes;
  std::string format, output, name;
  std::optional<long> instance, device_id;
  bool fit_cubic = false, force = false;
  std::optional<std::string> rest;
  std::optional<double> ramp;         // [K/min]
  std::optional<double> correlation;  // [K]
  std::optional<double> temperature;  // [degC]
};

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

struct NamedCompensator {
  fs::path file;
  Compensator compensator;
};

// Runs `work` and puts the name of the compensator's file before an error.
template <class Work>
auto of_file(const fs::path& file, Work work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}: {}", file.string(), error.what()));
  }
}

// One axis for each compensator.
std::vector<char> axes_of(const ExportArguments& arguments) {
  const std::size_t count = arguments.compensators.size();
  std::vector<char> axes;
  for (const std::string& axis : arguments.axes) axes.push_back(axis[0]);
  if (axes.empty() && count == 1) axes = {'z'};
  if (axes.empty() && count == 3) axes = {'x', 'y', 'z'};
  if (axes.size() != count)
    throw std::invalid_argument(
        fmt::format("--axis: {} axes for {} compensators; one each, such as "
                    "--axis x,y",
                    axes.size(), count));
  for (std::size_t k = 1; k < count; ++k)
    if (std::find(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(k),
                  axes[k]) != axes.begin() + static_cast<std::ptrdiff_t>(k))
      throw std::invalid_argument(fmt::format(
          "--axis: {} twice; each compensator has an axis of its own",
          axes[k]));
  return axes;
}

void warn_of_ranges(const std::vector<AutopilotAxis>& axes) {
  const TemperatureRange common = common_range(axes);
  if (std::ranges::all_of(axes, [&](const AutopilotAxis& axis) {
        return axis.range == common;
      }))
    return;
  print_warning(fmt::format(
      "the axes were trained over different temperatures: the autopilot will "
      "clamp all of them to {:.2f} to {:.2f} degC, which all have seen",
      common.lowest, common.highest));
}

NamedTexts parameter_texts(const ExportArguments& arguments,
                           const std::vector<NamedCompensator>& compensators,
                           const std::string& name) {
  const std::vector<char> places = axes_of(arguments);
  std::vector<AutopilotAxis> axes;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Compensator& compensator = compensators[k].compensator;
    const auto cubic = [&] {
      return autopilot_cubic(compensator, arguments.fit_cubic);
    };
    axes.push_back({places[k], of_file(compensators[k].file, cubic),
                    compensator.temperature_range});
  }
  const bool px4 = arguments.format == "px4";
  const AutopilotGyro gyro{
      static_cast<int>(arguments.instance.value_or(px4 ? 0 : 1)),
      arguments.device_id.value_or(0)};
  NamedTexts texts = {
      {name + (px4 ? ".params" : ".parm"), of_file(compensators[0].file, [&] {
         return px4 ? px4_parameters(axes, gyro)
                    : ardupilot_parameters(axes, gyro);
       })}};
  warn_of_ranges(axes);
  return texts;
}

NamedTexts c_texts(const ExportArguments& arguments, const NamedCompensator& of,
                   const std::string& name) {
  const ExportedC c = of_file(
      of.file, [&] { return export_c(of.compensator, name, arguments.force); });
  for (const std::string& warning : c.warnings)
    print_warning(fmt::format("{}: {}", of.file.string(), warning));
  return {{name + ".h", c.header},
          {name + ".c", c.source},
          {name + "_selftest.c", c.self_test},
          {name + "_plugin.c", c.plugin}};
}

// Before a long recording is read.
void require_sigma(const NamedCompensator& of) {
  if (!of.compensator.sigma)
    throw std::invalid_argument(fmt::format(
        "{}: states no sigma, from which the bias noise of a filter is "
        "computed; expected a compensator with the member sigma",
        of.file.string()));
}

EkfSource ekf_source(const fs::path& file) {
  return {file.filename().string(), sha256_of_file(file)};
}

NamedTexts ekf_files(const ExportArguments& arguments,
                     const NamedCompensator& of, const std::string& name) {
  if (!arguments.rest)
    throw std::invalid_argument(
        "--rest is missing; expected a recording at rest, from which the noise "
        "is taken");
  EkfExport given{.name = name,
                  .axis = axes_of(arguments)[0],
                  .compensator = ekf_source(of.file),
                  .rest = {},
                  .settings = {},
                  .noise = {},
                  .figures = {}};
  EkfSettings& settings = given.settings;
  settings.temperature = arguments.temperature;
  if (arguments.ramp) settings.temperature_rate = *arguments.ramp / 60.0;
  settings.correlation = arguments.correlation.value_or(settings.correlation);
  require_sigma(of);
  const Recording rest = load_recording(*arguments.rest);
  given.noise = of_file(*arguments.rest,
                        [&] { return rest_noise(of.compensator, rest); });
  given.rest = ekf_source(*arguments.rest);
  given.figures = ekf_figures(of.compensator, given.noise, settings);
  for (const std::string& warning : ekf_warnings(given)) print_warning(warning);
  return ekf_texts(given);
}

void require_options(const ExportArguments& arguments) {
  const auto refuse = [&](bool given, const char* option, const char* formats) {
    if (given)
      throw std::invalid_argument(
          fmt::format("{}: is for the formats {}, not for {}", option, formats,
                      arguments.format));
  };
  const std::string& format = arguments.format;
  if (format != "px4")
    refuse(arguments.device_id.has_value(), "--device-id", "px4");
  if (format != "c") refuse(arguments.force, "--force", "c");
  if (format != "ekf") {
    refuse(arguments.rest.has_value(), "--rest", "ekf");
    refuse(arguments.ramp.has_value(), "--ramp-K-per-min", "ekf");
    refuse(arguments.correlation.has_value(), "--correlation-K", "ekf");
    refuse(arguments.temperature.has_value(), "--temperature-degC", "ekf");
  }
  if (format == "px4" || format == "ardupilot") return;
  if (format == "c")
    refuse(!arguments.axes.empty(), "--axis", "px4, ardupilot and ekf");
  refuse(arguments.instance.has_value(), "--instance", "px4 and ardupilot");
  refuse(arguments.fit_cubic, "--fit-cubic", "px4 and ardupilot");
  refuse(arguments.compensators.size() > 1, "several compensators",
         "px4 and ardupilot");
}

// Checks all outputs before the first is written.
void require_outputs(const fs::path& directory, const NamedTexts& texts,
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

// Writes all files or none.
void write_texts(const fs::path& directory, const NamedTexts& texts) {
  const MadeDirectories made(directory);
  std::vector<fs::path> written;
  try {
    for (const auto& [called, text] : texts) {
      write_text_file(directory / called, text);
      written.push_back(directory / called);
    }
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& path : written) fs::remove(path, ignored);
    throw;
  }
}

int run_export(const ExportArguments& arguments) {
  require_options(arguments);
  std::vector<NamedCompensator> compensators;
  for (const std::string& file : arguments.compensators)
    compensators.push_back({file, read_compensator(file)});
  const std::string name =
      c_identifier(arguments.name.empty() ? compensators[0].file.stem().string()
                                          : arguments.name);
  const NamedTexts texts = arguments.format == "c"
                               ? c_texts(arguments, compensators[0], name)
                           : arguments.format == "ekf"
                               ? ekf_files(arguments, compensators[0], name)
                               : parameter_texts(arguments, compensators, name);
  std::vector<fs::path> inputs = {arguments.compensators.begin(),
                                  arguments.compensators.end()};
  if (arguments.rest) inputs.emplace_back(*arguments.rest);
  require_outputs(arguments.output, texts, inputs);
  require_directory_name(arguments.output);
  write_texts(arguments.output, texts);
  if (arguments.format == "px4" && arguments.device_id.value_or(0) == 0)
    print_warning(
        "TC_Gn_ID is 0: PX4 applies the parameters to the sensor with this id "
        "only; pass --device-id");
  return 0;
}

}  // namespace

void add_export(CommandLine& program) {
  auto arguments = std::make_shared<ExportArguments>();
  Command& command =
      program.add("export", kCompensation,
                  "Writes a compensator as C source, autopilot parameters or "
                  "noise of navigation filters");
  command.arguments({"COMPENSATOR.json...", "",
                     "One compensator; for px4 and ardupilot up to three, one "
                     "for each axis"},
                    arguments->compensators, 3);
  command.reads({{FileKind::kCompensator}});
  command.choice(
      {"--format", "c|px4|ardupilot|ekf",
       "c writes NAME.h, NAME.c, NAME_selftest.c and NAME_plugin.c; px4 writes "
       "NAME.params; ardupilot writes NAME.parm; ekf writes NAME_ekf.json and "
       "a file for each filter"},
      arguments->format, {"c", "px4", "ardupilot", "ekf"});
  command.text({"-o,--output", "DIR", "Directory to write to"},
               arguments->output);
  command.text({"--name", "NAME", "Name of the files and of the C functions",
                "the file name of the (first) compensator"},
               arguments->name);
  command.group("C");
  command.flag({"--force", "",
                "Exports a compensator that cancels the rate, or that single "
                "precision changes by more than 1e-4 deg/s; the code carries a "
                "warning"},
               arguments->force);
  command.group("PX4 and ArduPilot");
  command.choices({"--axis", "x|y|z",
                   "Axis of the autopilot's gyro for each compensator, as in "
                   "x,y; of the robot for ekf",
                   "z for one compensator and x,y,z for three"},
                  arguments->axes, {"x", "y", "z"});
  command.integer({"--instance", "N",
                   "Number of the autopilot's gyro, 0 to 3 for px4 and 1 to 3 "
                   "for ardupilot",
                   "the first"},
                  arguments->instance);
  command.integer({"--device-id", "ID", "px4: identifier of the sensor", "0"},
                  arguments->device_id, {0, 2147483647});
  command.flag({"--fit-cubic", "",
                "Exports the cubic fitted to the same rows if the compensator "
                "is no cubic"},
               arguments->fit_cubic);
  command.group("Navigation filters (ekf)");
  command.text({"--rest", "RUN.h5",
                "Recording at rest, from which the noise is taken", "none"},
               arguments->rest);
  command.reads({{FileKind::kRecording}, {FileKind::kRecordingTable}});
  command.number({"--ramp-K-per-min", "R",
                  "Temperature rate that the bias noise is for", "1"},
                 arguments->ramp, {0, 1000});
  command.number({"--correlation-K", "L",
                  "Temperature over which the bias forgets itself", "10"},
                 arguments->correlation, positive());
  command.number({"--temperature-degC", "T", "Temperature at power-on",
                  "any of the training, equally likely"},
                 arguments->temperature, {-273.15, 1000});
  command.example("beamgyro export cubic.json --format c -o firmware",
                  "C source for the firmware of a gyro");
  command.example("beamgyro export x.json y.json z.json --format px4 -o params",
                  "Parameters for three axes");
  command.example(
      "beamgyro export z.json --format ekf --rest rest.h5 -o filters",
      "Noise parameters of navigation filters");
  command.action([arguments] { return run_export(*arguments); });
}

}  // namespace beamgyro::internal
