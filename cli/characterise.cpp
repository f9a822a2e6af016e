// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "include/beamgyro/device.h"

namespace beamgyro::internal {
namespace {

struct CharacteriseArguments {
  std::string device, output;
  std::string temperatures = "-40:60:0.25";
  std::vector<std::string> overrides;
};

[[noreturn]] void fail_temperatures(const std::string& text,
                                    const std::string& reason) {
  throw std::invalid_argument(fmt::format(
      "--beam-temperature {}: {}; expected START:STOP:STEP or one value, in "
      "degC",
      text, reason));
}

// Both ends belong to the grid; a single value is a grid of one.
std::vector<double> temperature_grid(const std::string& text) {
  const std::vector<double> parts = numbers_between(text, ':');
  if (parts.empty() || text.find_first_of(" \r") != text.npos ||
      !std::ranges::all_of(parts,
                           [](double one) { return std::isfinite(one); }))
    fail_temperatures(text, "not a number");
  if (parts.size() == 1) return parts;
  if (parts.size() != 3)
    fail_temperatures(text, "neither one nor three values");
  try {
    return even_temperatures(parts[0], parts[1], parts[2]);
  } catch (const std::invalid_argument& error) {
    fail_temperatures(text, error.what());
  }
}

// Empty for a device without crossings within the temperatures.
std::string crossing_table(const std::vector<SpuriousCrossing>& crossings) {
  if (crossings.empty()) return "";
  std::string text =
      "spurious mode         crosses at degC   bump deg/s   width K\n";
  for (const SpuriousCrossing& one : crossings)
    text += fmt::format("{:<20}  {:>15.2f}  {:>+11.4g}  {:>8.3g}\n", one.mode,
                        one.temperature, one.height, one.width);
  return text;
}

int characterise(const CharacteriseArguments& arguments) {
  const std::vector<double> grid = temperature_grid(arguments.temperatures);
  const auto device = Device::read(arguments.device, arguments.overrides);
  require_output(arguments.output, {arguments.device});
  require_ending(arguments.output, {".csv"});

  const Progress progress("characterising " + arguments.device);
  const Characteristic found = beamgyro::characterise(device, grid);
  write_text_file(arguments.output, found.csv);
  print_result(crossing_table(found.crossings));
  for (const std::string& warning : found.warnings) keep_warning(warning);
  return 0;
}

}  // namespace

void add_characterise(CommandLine& program) {
  const auto [command, arguments] = program.add<CharacteriseArguments>(
      "characterise", kSimulation,
      "Tabulates the steady state of a device over the temperature "
      "of its beam, without noise",
      characterise);
  command.text({"DEVICE.toml", "", "Device file"}, arguments.device);
  command.reads({{FileKind::kDevice}});
  command.text({"-o,--output", "OUT.csv", "Table to write"}, arguments.output);
  command.text({"--beam-temperature", "START:STOP:STEP",
                "Temperatures in degC, both ends included, or one value",
                arguments.temperatures},
               arguments.temperatures);
  command.texts(
      {"--set", "KEY=VALUE", "Replaces a key of the device; may be repeated",
       "the file as it is"},
      arguments.overrides);
  command.example(
      "beamgyro characterise scenarios/devices/nominal.toml -o nominal.csv",
      "The shipped device from -40 to 60 degC");
  command.example(
      "beamgyro characterise scenarios/devices/nominal.toml -o hot.csv "
      "--beam-temperature 20:80:1 --set beam.length_m=0.038",
      "A shorter beam, in steps of 1 K");
}

}  // namespace beamgyro::internal
