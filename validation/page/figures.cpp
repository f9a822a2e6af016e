// SPDX-License-Identifier: MIT
#include "validation/page/figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "validation/page/figure_makers.h"

namespace beamgyro::internal {
namespace {

void check_runs(const Evidence& before, const Evidence& after) {
  const bool same = std::ranges::equal(
      before.runs, after.runs, [](const EvidenceRun& a, const EvidenceRun& b) {
        return a.name == b.name && a.purpose == b.purpose;
      });
  if (!same)
    throw std::invalid_argument(
        "figures need the same runs before and after compensation");
  for (const Evidence* evidence : {&before, &after})
    for (const EvidenceRun& run : evidence->runs)
      if (run.rate.size() != run.recording->time.size())
        throw std::invalid_argument(
            fmt::format("{}: {} rates for {} times, must be one each", run.name,
                        run.rate.size(), run.recording->time.size()));
}

/// Share [%] of the devices whose value is at most x.
FigureSeries share_of_devices(const std::string& role,
                              std::span<const double> values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  std::ranges::sort(sorted);
  FigureSeries series{role, role};
  const std::size_t step = sorted.size() / kFigurePoints + 1;
  for (std::size_t k = 0; k < sorted.size(); ++k)
    if (k % step == 0 || k + 1 == sorted.size())
      series.add(sorted[k], 100.0 * static_cast<double>(k + 1) /
                                static_cast<double>(values.size()));
  return series;
}

/// "bias pp" of bias_pp_deg_per_s, in deg/s.
std::string spoken_name(std::string name, const std::string& unit) {
  std::string suffix = "_";
  for (const char c : unit) suffix += c == '/' ? "_per_" : std::string(1, c);
  if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace

nlohmann::ordered_json figures_of(const Evidence& before,
                                  const Evidence& after) {
  check_runs(before, after);
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const auto& make :
       {bias_over_temperature_figures, hysteresis_figures, warm_up_figures,
        residual_histogram_figures, rate_table_figures,
        frequency_response_figures, rate_step_figures, allan_figures})
    for (const Figure& figure : make({before, after}))
      if (!figure.series.empty()) figures.push_back(to_json(figure));
  return figures;
}

nlohmann::ordered_json population_figure(const PopulationMetric& metric,
                                         const std::optional<double>& limit) {
  const std::string unit(metric.metric->unit), id(metric.metric->name);
  const std::string name = spoken_name(id, unit);
  Figure figure{"population_" + id,
                "Yield: " + name,
                fmt::format("Share of {} devices whose {} is at most the value "
                            "on the axis.",
                            metric.after.size(), name),
                {name, unit},
                {"Share of the devices", "%"}};
  figure.x.label[0] = static_cast<char>(std::toupper(figure.x.label[0]));
  FigureSeries before = share_of_devices("before", metric.before);
  FigureSeries after = share_of_devices("after", metric.after);
  // Values of one sign that differ much are told apart by their ratios.
  figure.x.logarithmic = !before.x.empty() && !after.x.empty() &&
                         before.x.front() > 0.0 && after.x.front() > 0.0 &&
                         (!limit || *limit > 0.0);
  figure.add(std::move(before));
  figure.add(std::move(after));
  if (limit) figure.add({"limit", "limit", {*limit, *limit}, {0.0, 100.0}});
  return to_json(figure);
}

}  // namespace beamgyro::internal
