// SPDX-License-Identifier: MIT
#include "include/beamgyro/sensitivity.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "api/sensitivity_study.h"
#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"

namespace beamgyro::internal {
namespace {

struct SensitivityArguments {
  std::string campaign, json, compensator, pictures;
  std::string range = "-40:50";
  std::vector<std::string> limits;
  SensitivityOptions options;
};

std::map<std::string, double> limits_of(const SensitivityArguments& arguments) {
  std::map<std::string, double> limits;
  for (const std::string& text : arguments.limits) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--limit {}: expected FIGURE=VALUE, for instance "
                      "bias_pp_deg_per_s=2",
                      text));
    const std::string name =
        one_of("--limit", text.substr(0, equals), merit_names());
    const double limit =
        decimal_number("--limit", text.substr(equals + 1),
                       {0, std::numeric_limits<double>::max(), true, false});
    if (!limits.try_emplace(name, limit).second)
      throw std::invalid_argument(fmt::format(
          "--limit {}: {} has a limit already; expected one for each figure",
          text, name));
  }
  return limits;
}

SensitivityResult run_with_progress(const Campaign& campaign,
                                    const SensitivityOptions& options) {
  DeviceSampleCounts counts;
  const auto done = [&] {
    const auto devices = static_cast<double>(counts.devices.load());
    const auto all = static_cast<double>(counts.all_devices.load());
    return Progress::Status{all > 0 ? devices / all : 0,
                            fmt::format("{} of {} devices, {} failed", devices,
                                        all, counts.failures.load())};
  };
  const Progress progress("sampling " + campaign.name(), done);
  return studied(campaign, options, counts);
}

void require_places(const SensitivityArguments& arguments,
                    const Campaign& campaign) {
  std::vector<std::filesystem::path> inputs;
  for (const InputFile& file : campaign.files()) inputs.push_back(file.path);
  if (!arguments.compensator.empty())
    inputs.emplace_back(arguments.compensator);
  require_json_output(arguments.json, inputs);
  require_output_directory("--pictures", arguments.pictures, "result.json",
                           inputs);
}

SensitivityOptions options_of(const SensitivityArguments& arguments) {
  SensitivityOptions options = arguments.options;
  if (!arguments.compensator.empty())
    options.compensator = Compensator::read(arguments.compensator);
  std::tie(options.lowest_degC, options.highest_degC) =
      temperature_range("--range", arguments.range);
  options.limits = limits_of(arguments);
  return options;
}

int sensitivity(const SensitivityArguments& arguments) {
  const auto campaign = Campaign::read(arguments.campaign);
  const SensitivityOptions options = options_of(arguments);
  require_places(arguments, campaign);
  const SensitivityResult result = run_with_progress(campaign, options);
  print_result(result.text);
  for (const std::string& warning : result.warnings) print_warning(warning);
  if (!arguments.json.empty()) write_text_file(arguments.json, result.json);
  if (!arguments.pictures.empty()) {
    const MadeDirectories made(arguments.pictures);
    draw_figures(result.json, arguments.pictures);
  }
  return 0;
}

void add_questions(Command& command, SensitivityArguments& arguments) {
  command.choices(
      {"--figure", "NAME",
       "Figures of merit, between commas or repeated: bias_pp_deg_per_s, "
       "cubic_rms_deg_per_s, scale_factor_drift_rel, warm_up_change_deg_per_s, "
       "quadrature_deg_per_s, compensator_rms_deg_per_s",
       "the first four"},
      arguments.options.figures, merit_names());
  command.text(
      {"--compensator", "FILE.json",
       "Adds compensator_rms_deg_per_s: what this compensator leaves", "none"},
      arguments.compensator);
  command.reads({{FileKind::kCompensator}});
  command.text({"--range", "LOW:HIGH", "Temperatures in degC", arguments.range},
               arguments.range);
  command.flag({"--linear", "",
                "Studies every figure as it is, not the logarithm of those "
                "that are always positive"},
               arguments.options.linear);
  command.texts(
      {"--limit", "FIGURE=VALUE",
       "Largest magnitude that is good; adds the share of good "
       "devices, as it is, with each tolerance halved and with two at "
       "once; may be repeated",
       "no limit"},
      arguments.limits);
  command.number({"--yield", "SHARE",
                  "Share of good devices that is wanted, as in 0.95; adds how "
                  "narrow single tolerances have to be for it",
                  "not asked"},
                 arguments.options.yield, {0, 1, true, true});
}

}  // namespace

void add_sensitivity(CommandLine& program) {
  const auto [command, arguments] = program.add<SensitivityArguments>(
      "sensitivity", kSimulation,
      "Tells which tolerance of a campaign causes the spread of drift, by "
      "Sobol' indices",
      sensitivity);
  command.text({"CAMPAIGN.toml", "", "Campaign file"}, arguments.campaign);
  command.reads({{FileKind::kCampaign}});
  add_questions(command, arguments);
  command.group("Size and files");
  command.integer({"--samples", "N",
                   "Samples; each takes a device for every tolerance and three "
                   "more. Powers of two serve best",
                   "2048"},
                  arguments.options.samples, {32, 1000000});
  command.integer(
      {"--seed", "N", "Seed of the samples", "that of the campaign"},
      arguments.options.seed);
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments.options.jobs, {1, 4096});
  command.text({"--json", "FILE", "Writes all of it to FILE", "no file"},
               arguments.json);
  command.text({"--pictures", "DIR",
                "Draws a bar chart of each figure into DIR; needs Python with "
                "matplotlib",
                "none"},
               arguments.pictures);
  command.example("beamgyro sensitivity scenarios/campaigns/population.toml",
                  "The tolerances of the shipped population");
  command.example(
      "beamgyro sensitivity scenarios/campaigns/population.toml --figure "
      "bias_pp_deg_per_s --limit bias_pp_deg_per_s=2",
      "How many devices drift by at most 2 deg/s");
}

}  // namespace beamgyro::internal
