// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "api/curve_treatment.h"
#include "api/file_kind.h"
#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "include/beamgyro/curves.h"
#include "include/beamgyro/device.h"

namespace beamgyro::internal {
namespace {

struct CharacteriseArguments {
  std::string input, output;
  std::string temperatures = "-40:60:0.25";
  std::vector<std::string> overrides;
  // of a campaign
  std::optional<std::uint32_t> devices;
  std::optional<unsigned> jobs;
  std::string range, json;
  CurveTreatment treatment;
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

int characterise_device(const CharacteriseArguments& arguments,
                        const std::vector<double>& grid) {
  const auto device = Device::read(arguments.input, arguments.overrides);
  require_output(arguments.output, {arguments.input});
  require_ending(arguments.output, {".csv"});

  const Progress progress("characterising " + arguments.input);
  const Characteristic found = beamgyro::characterise(device, grid);
  write_text_file(arguments.output, found.csv);
  print_result(crossing_table(found.crossings));
  for (const std::string& warning : found.warnings) keep_warning(warning);
  return 0;
}

/// Returns the first option that is given and is for campaigns only, or "".
std::string option_of_campaigns(const CharacteriseArguments& arguments) {
  if (arguments.devices) return "--devices";
  if (!arguments.range.empty()) return "--range";
  if (arguments.treatment.zero_at_degC) return "--zero-at";
  if (arguments.treatment.round_deg_per_s) return "--round";
  if (arguments.jobs) return "--jobs";
  return arguments.json.empty() ? "" : "--json";
}

/// Returns how curves are treated that are described, or nothing when too few
/// temperatures are there for that and no option asks for it.
std::optional<CurveTreatment> treatment_of(
    const CharacteriseArguments& arguments, const std::vector<double>& grid) {
  CurveTreatment treatment = arguments.treatment;
  if (!arguments.range.empty())
    std::tie(treatment.lowest_degC, treatment.highest_degC) =
        temperature_range("--range", arguments.range);
  const bool is_asked = !arguments.range.empty() || !arguments.json.empty() ||
                        treatment.zero_at_degC || treatment.round_deg_per_s;
  try {
    check_treatment(grid, treatment);
    return treatment;
  } catch (const std::invalid_argument&) {
    if (is_asked) throw;
    return {};
  }
}

CampaignCurves curves_with_progress(const Campaign& campaign,
                                    const std::vector<double>& grid,
                                    unsigned jobs) {
  Progress progress("characterising " + campaign.name());
  return beamgyro::characterise(
      campaign, grid, {.jobs = jobs, .progress = progress.shown_share()});
}

int characterise_campaign(const CharacteriseArguments& arguments,
                          const std::vector<double>& grid) {
  if (!arguments.overrides.empty())
    throw std::invalid_argument(
        fmt::format("--set {}: {} is a campaign; expected a device file, or "
                    "the value in the campaign",
                    arguments.overrides.front(), arguments.input));
  const auto campaign = Campaign::read(arguments.input, arguments.devices);
  const auto treatment = treatment_of(arguments, grid);
  std::vector<std::filesystem::path> inputs;
  for (const InputFile& file : campaign.files()) inputs.push_back(file.path);
  require_ending(arguments.output, {".csv", ".h5"});
  require_json_output(arguments.json, inputs);
  require_output(arguments.output, inputs);

  const CampaignCurves curves =
      curves_with_progress(campaign, grid, arguments.jobs.value_or(0));
  if (treatment) {
    const CurveFigureResult figures =
        curve_figures(curves.temperature, curves.columns.front().values,
                      curves.devices, *treatment, campaign.name());
    print_result(figures.text);
    if (!arguments.json.empty()) write_text_file(arguments.json, figures.json);
  }
  write_curves(curves, campaign, arguments.output);
  for (const std::string& warning : curves.warnings) keep_warning(warning);
  return 0;
}

int characterise(const CharacteriseArguments& arguments) {
  const std::vector<double> grid = temperature_grid(arguments.temperatures);
  if (is_of_kind(arguments.input, FileKind::kCampaign))
    return characterise_campaign(arguments, grid);
  const std::string option = option_of_campaigns(arguments);
  if (!option.empty() && is_of_kind(arguments.input, FileKind::kDevice))
    throw std::invalid_argument(
        fmt::format("{}: {} is a device file; expected a campaign with it",
                    option, arguments.input));
  return characterise_device(arguments, grid);
}

void add_options_of_campaigns(Command& command,
                              CharacteriseArguments& arguments) {
  command.group("Campaigns");
  command.integer(
      {"--devices", "N", "Number of devices", "that of the campaign"},
      arguments.devices, {1, kLastDevice});
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments.jobs, {1, 4096});
  command.text(
      {"--range", "LOW:HIGH",
       "Temperatures in degC by which the curves are described", "all of them"},
      arguments.range);
  command.number({"--zero-at", "T",
                  "Describes each curve less its value at this temperature in "
                  "degC",
                  "as it is"},
                 arguments.treatment.zero_at_degC);
  command.number({"--round", "STEP",
                  "Describes the curves at multiples of STEP in deg/s, as if "
                  "read from a drawing",
                  "as they are"},
                 arguments.treatment.round_deg_per_s,
                 {0, std::numeric_limits<double>::max(), true, false});
  command.text(
      {"--json", "FILE", "Writes what describes the curves to FILE", "no file"},
      arguments.json);
}

}  // namespace

void add_characterise(CommandLine& program) {
  const auto [command, arguments] = program.add<CharacteriseArguments>(
      "characterise", kSimulation,
      "Tabulates the steady state of a device, or of each device of a "
      "campaign, over the temperature of its beam, without noise",
      characterise);
  command.text({"DEVICE.toml|CAMPAIGN.toml", "", "Device or campaign file"},
               arguments.input);
  command.reads({{FileKind::kDevice, FileKind::kCampaign}});
  command.text({"-o,--output", "OUT.csv|h5",
                "Table to write; of a campaign the bias of each device as CSV, "
                "or all columns of each as HDF5"},
               arguments.output);
  command.text({"--beam-temperature", "START:STOP:STEP",
                "Temperatures in degC, both ends included, or one value",
                arguments.temperatures},
               arguments.temperatures);
  command.texts(
      {"--set", "KEY=VALUE",
       "Replaces a key of the device of a device file; may be repeated",
       "the file as it is"},
      arguments.overrides);
  add_options_of_campaigns(command, arguments);
  command.example(
      "beamgyro characterise scenarios/devices/nominal.toml -o nominal.csv",
      "The shipped device from -40 to 60 degC");
  command.example(
      "beamgyro characterise scenarios/devices/nominal.toml -o hot.csv "
      "--beam-temperature 20:80:1 --set beam.length_m=0.038",
      "A shorter beam, in steps of 1 K");
  command.example(
      "beamgyro characterise scenarios/campaigns/population.toml --devices 300 "
      "--range -20:50 --zero-at 25 -o curves.h5",
      "300 devices of a population, described as data sheets do");
}

}  // namespace beamgyro::internal
