// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/made_directories.h"
#include "report/sensitivity_report.h"
#include "sensitivity/figures/figure_of_merit.h"
#include "sensitivity/study/device_sample.h"
#include "sensitivity/study/factor.h"
#include "sensitivity/study/sensitivity_study.h"
#include "sim/campaign/campaign.h"
#include "sim/thermal/material_range.h"

namespace beamgyro::internal {
namespace {

struct SensitivityArguments {
  std::string campaign, json, compensator, pictures;
  std::string range = "-40:50";
  std::vector<std::string> figures, limits;
  std::optional<long> samples, jobs, seed;
  bool linear = false;
};

std::vector<std::string> merit_names() {
  std::vector<std::string> names;
  for (const FigureOfMerit& figure : figures_of_merit())
    names.emplace_back(figure.name);
  return names;
}

CurveGrid grid_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    throw std::invalid_argument(fmt::format(
        "--range {}: expected LOW:HIGH in degC, for instance -40:50", text));
  CurveGrid grid;
  grid.low =
      decimal_number("--range", text.substr(0, colon), kMaterialTemperatures);
  grid.high =
      decimal_number("--range", text.substr(colon + 1), kMaterialTemperatures);
  if (!(grid.high - grid.low >= 1))
    throw std::invalid_argument(fmt::format(
        "--range {}: spans {:g} K; expected LOW at least 1 K below HIGH", text,
        grid.high - grid.low));
  return grid;
}

// The figures asked for, each once; without any those that need no compensator.
std::vector<Merit> merits_of(const SensitivityArguments& arguments) {
  const bool has_compensator = !arguments.compensator.empty();
  std::vector<Merit> merits;
  for (const std::string& name : arguments.figures) {
    const Merit merit = find_figure_of_merit(name)->merit;
    if (std::ranges::count(merits, merit) == 0) merits.push_back(merit);
  }
  const bool asks = std::ranges::count(merits, Merit::kCompensatorRms) > 0;
  if (asks && !has_compensator)
    throw std::invalid_argument(fmt::format(
        "--figure {}: no compensator to score; expected --compensator "
        "FILE.json with it",
        figure_of_merit(Merit::kCompensatorRms).name));
  if (arguments.figures.empty())
    merits = {Merit::kBiasPeakToPeak, Merit::kCubicRms,
              Merit::kScaleFactorDrift, Merit::kWarmUpChange};
  if (has_compensator && !asks) merits.push_back(Merit::kCompensatorRms);
  return merits;
}

std::map<Merit, double> limits_of(const SensitivityArguments& arguments,
                                  const std::vector<Merit>& merits) {
  std::map<Merit, double> limits;
  for (const std::string& text : arguments.limits) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw std::invalid_argument(
          fmt::format("--limit {}: expected FIGURE=VALUE, for instance "
                      "bias_pp_deg_per_s=2",
                      text));
    const std::string name =
        one_of("--limit", text.substr(0, equals), merit_names());
    const Merit merit = find_figure_of_merit(name)->merit;
    if (std::ranges::count(merits, merit) == 0)
      throw std::invalid_argument(fmt::format(
          "--limit {}: {} is not studied; expected --figure {} with it", text,
          name, name));
    const double limit =
        decimal_number("--limit", text.substr(equals + 1),
                       {0, std::numeric_limits<double>::max(), true, false});
    if (!limits.try_emplace(merit, limit).second)
      throw std::invalid_argument(fmt::format(
          "--limit {}: {} has a limit already; expected one for each figure",
          text, name));
  }
  return limits;
}

DeviceSample sample_with_progress(const Campaign& campaign,
                                  const DeviceSampleOptions& options) {
  DeviceSampleCounts counts;
  const auto total = static_cast<double>(devices_of_sample(campaign, options));
  const auto done = [&] {
    const auto devices = static_cast<double>(counts.devices.load());
    return Progress::Status{devices / total,
                            fmt::format("{} of {} devices, {} failed", devices,
                                        total, counts.failures.load())};
  };
  const Progress progress("sampling " + campaign.name(), done);
  return sample_devices(campaign, options, counts);
}

void require_places(const SensitivityArguments& arguments,
                    const Campaign& campaign) {
  std::vector<std::filesystem::path> inputs;
  for (const SourceText& source : campaign.sources())
    inputs.push_back(source.path);
  if (!arguments.compensator.empty())
    inputs.emplace_back(arguments.compensator);
  if (!arguments.json.empty()) {
    require_output(arguments.json, inputs);
    require_json_name(arguments.json);
  }
  if (!arguments.pictures.empty())
    require_output_directory("--pictures", arguments.pictures, "result.json",
                             inputs);
}

DeviceSampleOptions options_of(const SensitivityArguments& arguments,
                               const Campaign& campaign) {
  DeviceSampleOptions options;
  options.merits = merits_of(arguments);
  options.merit.grid = grid_of(arguments.range);
  if (!arguments.compensator.empty())
    options.merit.compensator = std::make_shared<const Compensator>(
        read_compensator(arguments.compensator));
  options.rows = static_cast<std::size_t>(arguments.samples.value_or(2048));
  options.seed = arguments.seed ? static_cast<std::uint64_t>(*arguments.seed)
                                : campaign.seed();
  options.halves_tolerances = !arguments.limits.empty();
  options.jobs = static_cast<unsigned>(arguments.jobs.value_or(0));
  return options;
}

int sensitivity(const SensitivityArguments& arguments) {
  const Campaign campaign = Campaign::read(arguments.campaign);
  const DeviceSampleOptions options = options_of(arguments, campaign);
  const std::map<Merit, double> limits = limits_of(arguments, options.merits);
  require_comparable(factors_of(campaign.device_plan()), arguments.campaign);
  require_places(arguments, campaign);
  const DeviceSample sample = sample_with_progress(campaign, options);
  const StudyHead head{campaign.name(), options.seed, options.merit.grid};
  std::string text = sample_lines(sample, head);
  std::vector<MeritResult> results;
  for (std::size_t m = 0; m < options.merits.size(); ++m) {
    const Merit merit = options.merits[m];
    const auto limit = limits.find(merit);
    MeritQuestion question{
        merit, figure_of_merit(merit).is_positive && !arguments.linear};
    if (limit != limits.end()) question.limit = limit->second;
    results.push_back(analysed(sample, m, question, options.seed));
    text += '\n' + sensitivity_table(results.back());
  }
  print_result(text);
  const std::string json = to_json(sample, head, results).dump(2) + "\n";
  if (!arguments.json.empty()) write_text_file(arguments.json, json);
  if (!arguments.pictures.empty()) {
    const MadeDirectories made(arguments.pictures);
    draw_figures(json, arguments.pictures);
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
      arguments.figures, merit_names());
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
               arguments.linear);
  command.texts({"--limit", "FIGURE=VALUE",
                 "Largest magnitude that is good; adds the share of good "
                 "devices, as it is and with each tolerance halved; may be "
                 "repeated",
                 "no limit"},
                arguments.limits);
}

}  // namespace

void add_sensitivity(CommandLine& program) {
  auto arguments = std::make_shared<SensitivityArguments>();
  Command& command = program.add(
      "sensitivity", kSimulation,
      "Tells which tolerance of a campaign causes the spread of drift, by "
      "Sobol' indices");
  command.argument({"CAMPAIGN.toml", "", "Campaign file"}, arguments->campaign);
  command.reads({{FileKind::kCampaign}});
  add_questions(command, *arguments);
  command.group("Size and files");
  command.integer({"--samples", "N",
                   "Samples; each takes a device for every tolerance and three "
                   "more. Powers of two serve best",
                   "2048"},
                  arguments->samples, {32, 1000000});
  command.integer(
      {"--seed", "N", "Seed of the samples", "that of the campaign"},
      arguments->seed);
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments->jobs, {1, 4096});
  command.text({"--json", "FILE", "Writes all of it to FILE", "no file"},
               arguments->json);
  command.text({"--pictures", "DIR",
                "Draws a bar chart of each figure into DIR; needs Python with "
                "matplotlib",
                "none"},
               arguments->pictures);
  command.example("beamgyro sensitivity scenarios/campaigns/population.toml",
                  "The tolerances of the shipped population");
  command.example(
      "beamgyro sensitivity scenarios/campaigns/population.toml --figure "
      "bias_pp_deg_per_s --limit bias_pp_deg_per_s=2",
      "How many devices drift by at most 2 deg/s");
  command.action([arguments] { return sensitivity(*arguments); });
}

}  // namespace beamgyro::internal
