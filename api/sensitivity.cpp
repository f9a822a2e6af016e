// SPDX-License-Identifier: MIT
#include "include/beamgyro/sensitivity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "api/checked_number.h"
#include "api/compensators.h"
#include "api/reported_progress.h"
#include "api/sensitivity_study.h"
#include "dataset/files/json_text.h"
#include "report/sensitivity_report.h"
#include "sensitivity/figures/figure_of_merit.h"
#include "sensitivity/study/device_sample.h"
#include "sensitivity/study/narrowed_yield.h"
#include "sensitivity/study/sensitivity_study.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro {
namespace internal {
namespace {

CurveGrid grid_of(const SensitivityOptions& options) {
  const double low = options.lowest_degC, high = options.highest_degC;
  check_range("range_degC", low, high, kMaterialTemperatures);
  if (!(high - low >= 1))
    throw std::invalid_argument(fmt::format(
        "temperatures from {:g} to {:g} degC span {:g} K; expected 1 K or more",
        low, high, high - low));
  CurveGrid grid;
  grid.low = low;
  grid.high = high;
  return grid;
}

Merit merit_of(const std::string& name) {
  if (const FigureOfMerit* found = find_figure_of_merit(name))
    return found->merit;
  throw std::invalid_argument(fmt::format("figure \"{}\"; expected {}", name,
                                          fmt::join(merit_names(), ", ")));
}

// The figures asked for, each once; without any those that need no compensator.
std::vector<Merit> merits_of(const SensitivityOptions& options) {
  const bool has_compensator = options.compensator.has_value();
  std::vector<Merit> merits;
  for (const std::string& name : options.figures) {
    const Merit merit = merit_of(name);
    if (std::ranges::count(merits, merit) == 0) merits.push_back(merit);
  }
  const bool asks = std::ranges::count(merits, Merit::kCompensatorRms) > 0;
  if (asks && !has_compensator)
    throw std::invalid_argument(
        fmt::format("figure {}: no compensator to score; expected a "
                    "compensator with it",
                    figure_of_merit(Merit::kCompensatorRms).name));
  if (options.figures.empty())
    merits = {Merit::kBiasPeakToPeak, Merit::kCubicRms,
              Merit::kScaleFactorDrift, Merit::kWarmUpChange};
  if (has_compensator && !asks) merits.push_back(Merit::kCompensatorRms);
  return merits;
}

std::map<Merit, double> limits_of(const SensitivityOptions& options,
                                  const std::vector<Merit>& merits) {
  std::map<Merit, double> limits;
  for (const auto& [name, limit] : options.limits) {
    const Merit merit = merit_of(name);
    if (std::ranges::count(merits, merit) == 0)
      throw std::invalid_argument(fmt::format(
          "limit {:g} of {}, which is not studied; expected it among the "
          "figures",
          limit, name));
    if (!(limit > 0))
      throw std::invalid_argument(
          fmt::format("limit {} of {}; expected one above 0", limit, name));
    limits.emplace(merit, limit);
  }
  return limits;
}

SensitivityFigure figure_of(const MeritResult& result) {
  SensitivityFigure figure{figure_of_merit(result.merit).name, {}};
  for (const FactorResult& factor : result.factors)
    figure.indices.push_back({factor.key, factor.first.value, factor.first.low,
                              factor.first.high, factor.total.value,
                              factor.total.low, factor.total.high});
  return figure;
}

DeviceSampleOptions sample_options(const Campaign& campaign,
                                   const SensitivityOptions& options) {
  DeviceSampleOptions sample;
  sample.merits = merits_of(options);
  sample.merit.grid = grid_of(options);
  if (options.compensator)
    sample.merit.compensator = std::make_shared<const FittedCompensator>(
        options.compensator->content().compensator);
  if (options.samples < 32 || options.samples > 1000000)
    throw std::invalid_argument(
        fmt::format("{} samples; expected 32 to 1000000", options.samples));
  sample.rows = options.samples;
  sample.seed = options.seed.value_or(campaign.seed());
  sample.halves_tolerances = !options.limits.empty();
  sample.jobs = options.jobs;
  return sample;
}

void add_narrowed(YieldResult& yield, const CampaignPlan& campaign,
                  DeviceSampleOptions options, Merit merit,
                  const std::vector<std::string>& keys,
                  const std::optional<double>& target,
                  DeviceSampleCounts& counts) {
  options.merits = {merit};
  const NarrowingStudy study{campaign, options, keys};
  add_pairs(yield, study, counts);
  if (target) add_needed(yield, *target, study, counts);
}

}  // namespace

std::vector<std::string> merit_names() {
  std::vector<std::string> names;
  for (const FigureOfMerit& figure : figures_of_merit())
    names.emplace_back(figure.name);
  return names;
}

SensitivityResult studied(const Campaign& campaign,
                          const SensitivityOptions& options,
                          DeviceSampleCounts& counts) {
  const DeviceSampleOptions asked = sample_options(campaign, options);
  const std::map<Merit, double> limits = limits_of(options, asked.merits);
  const CampaignPlan& own = campaign.content();
  require_comparable(factors_of(own.device_plan),
                     own.sources.front().path.string());
  const DeviceSample sample = sample_devices(own, asked, counts);
  const StudyHead head{campaign.name(), asked.seed, asked.merit.grid};
  SensitivityResult result;
  result.text = sample_lines(sample, head);
  std::vector<MeritResult> found;
  if (options.yield && limits.empty())
    throw std::invalid_argument(
        fmt::format("yield {:g} of no limit; expected a limit of a figure with "
                    "it",
                    *options.yield));
  check_number("yield", options.yield, {0, 1, true, true});
  for (std::size_t m = 0; m < asked.merits.size(); ++m) {
    const Merit merit = asked.merits[m];
    const auto limit = limits.find(merit);
    MeritQuestion question{
        merit, figure_of_merit(merit).is_positive && !options.linear};
    if (limit != limits.end()) question.limit = limit->second;
    found.push_back(analysed(sample, m, question, asked.seed));
    if (found.back().yield)
      add_narrowed(*found.back().yield, own, asked, merit, sample.keys,
                   options.yield, counts);
    result.text += '\n' + sensitivity_table(found.back());
    result.figures.push_back(figure_of(found.back()));
  }
  result.json = json_text(to_json(sample, head, found));
  const auto warn = [&](std::uint64_t count, const char* what) {
    if (count > 0)
      result.warnings.push_back(fmt::format("{}: {} of {} devices {}",
                                            campaign.name(), count,
                                            counts.devices.load(), what));
  };
  warn(counts.limited,
       "need more than drive.voltage_limit_V at some temperature; their loops "
       "do not lock there");
  warn(counts.saturated,
       "drift beyond readout.full_scale_deg_per_s at some temperature; their "
       "output saturates there");
  return result;
}

}  // namespace internal

SensitivityResult sensitivity(const Campaign& campaign,
                              const SensitivityOptions& options) {
  internal::DeviceSampleCounts counts;
  std::mutex one_at_a_time;
  if (options.progress)
    counts.on_device = [&] {
      const std::lock_guard lock(one_at_a_time);
      internal::report(options.progress,
                       static_cast<double>(counts.devices.load()) /
                           static_cast<double>(counts.all_devices.load()));
    };
  return internal::studied(campaign, options, counts);
}

}  // namespace beamgyro
