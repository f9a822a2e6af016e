// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/terminal.h"
#include "compensation/c_text.h"
#include "compensation/compensator_file.h"
#include "compensation/export_c.h"
#include "compensation/export_parameters.h"
#include "dataset/atomic_file.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  std::string compensator, format, output, name;
  std::optional<std::string> axis;
  std::optional<int> instance;
  std::optional<long> device_id;
  bool fit_cubic = false, force = false;
};

using NamedTexts = std::vector<std::pair<std::string, std::string>>;

AutopilotPlace place_of(const ExportArguments& arguments, int first_instance) {
  return {arguments.axis.value_or("z")[0],
          arguments.instance.value_or(first_instance),
          arguments.device_id.value_or(0)};
}

NamedTexts texts_of(const ExportArguments& arguments,
                    const Compensator& compensator, const std::string& name) {
  if (arguments.format == "c") {
    const ExportedC c = export_c(compensator, name, arguments.force);
    for (const std::string& warning : c.warnings)
      print_warning(fmt::format("{}: {}", arguments.compensator, warning));
    return {{name + ".h", c.header},
            {name + ".c", c.source},
            {name + "_selftest.c", c.self_test}};
  }
  const BiasModel cubic = autopilot_cubic(compensator, arguments.fit_cubic);
  const TemperatureRange& range = compensator.temperature_range;
  if (arguments.format == "px4")
    return {{name + ".params",
             px4_parameters(cubic, range, place_of(arguments, 0))}};
  return {{name + ".parm",
           ardupilot_parameters(cubic, range, place_of(arguments, 1))}};
}

void require_options(const ExportArguments& arguments) {
  const auto refuse = [&](bool given, const char* option, const char* formats) {
    if (given)
      throw std::invalid_argument(
          fmt::format("{}: is for the formats {}, not for {}", option, formats,
                      arguments.format));
  };
  if (arguments.format != "px4")
    refuse(arguments.device_id.has_value(), "--device-id", "px4");
  if (arguments.format != "c") {
    refuse(arguments.force, "--force", "c");
    return;
  }
  refuse(arguments.axis.has_value(), "--axis", "px4 and ardupilot");
  refuse(arguments.instance.has_value(), "--instance", "px4 and ardupilot");
  refuse(arguments.fit_cubic, "--fit-cubic", "px4 and ardupilot");
}

// Before anything is made.
void require_outputs(const fs::path& directory, const NamedTexts& texts,
                     const fs::path& input) {
  std::error_code ignored;
  if (!fs::exists(directory, ignored)) return;
  if (!fs::is_directory(directory, ignored))
    throw std::invalid_argument(fmt::format(
        "{}: a file; expected a directory that is there or can be made",
        directory.string()));
  for (const auto& [called, text] : texts)
    require_output(directory / called, {input});
}

// All of them or none.
void write_all(const fs::path& directory, const NamedTexts& texts) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw std::invalid_argument(
        fmt::format("{}: {}; expected a directory that is there or can be made",
                    directory.string(), error.message()));
  std::vector<fs::path> written;
  try {
    for (const auto& [called, text] : texts) {
      write_text_file(directory / called, text);
      written.push_back(directory / called);
    }
  } catch (...) {
    for (const fs::path& path : written) fs::remove(path, error);
    throw;
  }
}

int run_export(const ExportArguments& arguments) {
  require_options(arguments);
  const fs::path file = arguments.compensator;
  const Compensator compensator = read_compensator(file);
  const std::string name = c_identifier(
      arguments.name.empty() ? file.stem().string() : arguments.name);
  NamedTexts texts;
  try {
    texts = texts_of(arguments, compensator, name);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}: {}", file.string(), error.what()));
  }
  require_outputs(arguments.output, texts, file);
  write_all(arguments.output, texts);
  if (arguments.format == "px4" && arguments.device_id.value_or(0) == 0)
    print_warning(
        "TC_Gn_ID is 0: PX4 applies the parameters to the sensor with this id "
        "only; pass --device-id");
  return 0;
}

}  // namespace

void add_export(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = program.add_subcommand(
      "export", "Write a compensator as C source or autopilot parameters");
  command->add_option("compensator", arguments->compensator, "COMPENSATOR.json")
      ->required();
  command
      ->add_option("--format", arguments->format,
                   "c: NAME.h, NAME.c and NAME_selftest.c; px4: NAME.params; "
                   "ardupilot: NAME.parm")
      ->required()
      ->check(CLI::IsMember({"c", "px4", "ardupilot"}));
  command->add_option("-o,--output", arguments->output, "DIR")->required();
  command->add_option("--name", arguments->name,
                      "NAME; without it the compensator's file name");
  command
      ->add_option("--axis", arguments->axis,
                   "x, y or z: axis of the autopilot's gyro; z without it")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--instance", arguments->instance,
                   "of the autopilot's gyro: px4 0 to 3, ardupilot 1 to 3; the "
                   "first without it")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--device-id", arguments->device_id, "px4: of the sensor")
      ->check(CLI::Range(0, 2147483647));
  command->add_flag("--fit-cubic", arguments->fit_cubic,
                    "px4, ardupilot: of a compensator that is no cubic export "
                    "the cubic fitted to the same rows");
  command->add_flag("--force", arguments->force,
                    "c: export a compensator that cancels the rate, or that "
                    "single precision changes by more than 1e-4 deg/s; the "
                    "code carries the warning");
  command->callback([arguments, &action] {
    action = [arguments] { return run_export(*arguments); };
  });
}

}  // namespace beamgyro
