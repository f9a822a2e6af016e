// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "include/beamgyro/device_design.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShippedBase = "scenarios/devices/nominal.toml";

struct DeviceArguments {
  std::string base, output, temperatures, sensor_range;
  DataSheet sheet;
};

fs::path base_of(const DeviceArguments& arguments) {
  if (!arguments.base.empty()) return arguments.base;
  const fs::path shipped = shipped_file(kShippedBase);
  if (shipped.empty())
    throw std::invalid_argument(fmt::format(
        "{} is not beside this program; expected --like DEVICE.toml",
        kShippedBase));
  return shipped;
}

std::string figures_table(const DesignedDevice& made) {
  std::string text;
  for (const DesignFigure& f : made.figures)
    text += fmt::format("{:<18} {:>10.5g} {:<12} asked {:<10.5g} {}\n", f.name,
                        f.measured, f.unit, f.asked,
                        f.is_met() ? "met" : "NOT met");
  return text;
}

int run_device(const DeviceArguments& arguments) {
  require_ending(arguments.output, {".toml"});
  const fs::path base = base_of(arguments);
  require_output(arguments.output, {base});
  DataSheet sheet = arguments.sheet;
  if (!arguments.temperatures.empty())
    sheet.temperature_degC =
        temperature_range("--temperature-degC", arguments.temperatures);
  if (!arguments.sensor_range.empty())
    sheet.sensor_range_degC =
        temperature_range("--sensor-range-degC", arguments.sensor_range);
  const DesignedDevice made = design_device(Device::read(base), sheet);
  write_text_file(arguments.output, made.text);
  print_result(figures_table(made));
  for (const std::string& warning : made.warnings) print_warning(warning);
  return 0;
}

void add_beam_options(Command& command, DataSheet& s) {
  command.group("Beam");
  command.number({"--length", "M", "Length of the beam in m",
                  "from the frequency, or the base's"},
                 s.length);
  command.number({"--side", "M", "Side of its section in m",
                  "in proportion to the length"},
                 s.side);
  command.number({"--frequency-Hz", "F", "Drive frequency at 25 degC",
                  "what the beam gives"},
                 s.frequency_Hz);
  command.number({"--split-Hz", "F", "Sense less drive mode at 25 degC",
                  "in proportion to the frequency"},
                 s.split_Hz);
  command.number(
      {"--quality", "Q", "Quality factor of the drive mode at 25 degC",
       "what the materials give"},
      s.quality);
  command.number({"--air-quality", "Q",
                  "Quality factor that the gas alone "
                  "leaves",
                  "the base's, or what --quality needs"},
                 s.air_quality);
  command.choice({"--mount", "elastomer|epoxy|metal", "How the beam is held",
                  "the base's"},
                 s.mount, {"elastomer", "epoxy", "metal"});
}

void add_readout_options(Command& command, DataSheet& s) {
  command.group("Rate");
  command.number(
      {"--range-deg-per-s", "R", "Range, to both sides", "the full scale"},
      s.range_deg_per_s);
  command.number({"--full-scale-deg-per-s", "R", "Where the output clips",
                  "the range, or the base's"},
                 s.full_scale_deg_per_s);
  command.number({"--scale-factor-V-per-deg-per-s", "V", "Scale factor",
                  "from full scale and supply"},
                 s.scale_factor_V_per_deg_per_s);
  command.number({"--scale-tolerance-percent", "P", "Limit of its error, +-",
                  "the base's"},
                 s.scale_tolerance_percent);
  command.number({"--null-deg-per-s", "R", "Limit of the zero-rate output, +-",
                  "the base's"},
                 s.null_deg_per_s);
  command.number({"--bandwidth-Hz", "F", "Bandwidth, -3 dB", "the base's"},
                 s.bandwidth_Hz);
  command.number({"--noise-deg-per-s-per-sqrt-Hz", "N",
                  "Noise density, one-sided", "the base's"},
                 s.noise_deg_per_s_per_sqrt_Hz);
  command.number({"--walk-deg-per-sqrt-h", "N",
                  "Angle random walk, the same noise", "from the density"},
                 s.walk_deg_per_sqrt_h);
  command.number({"--instability-deg-per-h", "B",
                  "Bias instability, the least Allan deviation",
                  "in proportion to the noise"},
                 s.instability_deg_per_h);
  command.integer({"--adc-bits", "N", "Bits of the rate", "the base's"},
                  s.adc_bits);
}

void add_other_options(Command& command, DeviceArguments& arguments) {
  DataSheet& s = arguments.sheet;
  command.group("Temperature sensor");
  command.integer({"--bits", "N", "Bits of the temperature", "the base's step"},
                  s.bits);
  command.text(
      {"--sensor-range-degC", "LOW:HIGH", "What these bits divide", "-40:88"},
      arguments.sensor_range);
  command.number({"--resolution-K", "K", "Step of the temperature",
                  "from the bits, or the base's"},
                 s.resolution_K);
  command.number(
      {"--sensor-tolerance-K", "K", "Limit of its error, +-", "the base's"},
      s.sensor_tolerance_K);
  command.group("Supply and warm-up");
  command.number({"--supply-V", "V", "Supply", "the base's limits"},
                 s.supply_V);
  command.number({"--current-A", "A", "Supply current", "the power's"},
                 s.current_A);
  command.number({"--power-W", "W", "Power", "supply times current, or scaled"},
                 s.power_W);
  command.number({"--self-heating-K", "K", "Rise of the sensor in still air",
                  "what the power gives"},
                 s.self_heating_K);
  command.number({"--warm-up-s", "T", "Time to 95 % of that rise",
                  "in proportion to the squared length"},
                 s.warm_up_s);
  command.text(
      {"--temperature-degC", "LOW:HIGH",
       "In which the unit works, to warn of what fails there", "-40:50"},
      arguments.temperatures);
}

}  // namespace

void add_device(CommandLine& program) {
  const auto [command, arguments] = program.add<DeviceArguments>(
      "device", kSimulation,
      "Writes a device file from the figures of a data sheet", run_device);
  command.text({"-o,--output", "DEVICE.toml", "The device file to write"},
               arguments.output);
  command.text({"--like", "DEVICE.toml", "Base that has what no figure says",
                "the shipped nominal device"},
               arguments.base);
  command.reads({{FileKind::kDevice}});
  add_beam_options(command, arguments.sheet);
  add_readout_options(command, arguments.sheet);
  add_other_options(command, arguments);
  command.example(
      "beamgyro device --like scenarios/devices/nominal.toml --length 9e-3 "
      "--quality 400 --mount epoxy --bits 8 -o mine.toml",
      "A small gyro, with what was not said in proportion");
}

}  // namespace beamgyro::internal
