// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "validation/page/figure.h"
#include "validation/page/figures.h"

namespace beamgyro::internal {
namespace {

constexpr double kInPercent = 100.0;

FigureSeries pit_series(const std::string& name, const SigmaFit& fit) {
  FigureSeries series{name, "after"};
  if (!fit.pit) return series;
  for (std::size_t k = 0; k < kPitBins; ++k)
    series.add((static_cast<double>(k) + 0.5) / kPitBins,
               kInPercent * fit.pit->histogram[k]);
  return series;
}

FigureSeries coverage_series(const std::string& name, const SigmaFit& fit) {
  FigureSeries series{name, "after"};
  for (std::size_t k = 0; k < kCoverageLevels.size(); ++k)
    if (const auto& seen = fit.coverage[k])
      series.add(kInPercent * kCoverageLevels[k], kInPercent * seen->value,
                 Interval{kInPercent * seen->interval->low,
                          kInPercent * seen->interval->high});
  return series;
}

Figure pit_figure(const SigmaReport& report) {
  Figure figure{"sigma_pit",
                "Residuals on the scale of the stated sigma",
                "Distribution of Phi(residual / sigma). Level where sigma is "
                "right; high at both ends where it is too small, in the middle "
                "where it is too large.",
                {"Phi(residual / sigma)", "1"},
                {"Share", "%"},
                "line"};
  figure.add(pit_series("soaks", report.soaks));
  figure.add(pit_series("ramps", report.ramps));
  if (!figure.series.empty())
    figure.add({"a sigma that is right",
                "fit",
                {0.0, 1.0},
                {kInPercent / kPitBins, kInPercent / kPitBins}});
  return figure;
}

Figure coverage_figure(const SigmaReport& report) {
  Figure figure{"sigma_coverage",
                "Coverage of the stated sigma",
                "Share of the soaks and of the ramps that lie within the "
                "interval of that probability. Whiskers: 95 %.",
                {"Stated probability", "%"},
                {"Share within", "%"},
                "points"};
  figure.add(coverage_series("soaks", report.soaks));
  figure.add(coverage_series("ramps", report.ramps));
  if (!figure.series.empty())
    figure.add({"a sigma that is right",
                "fit",
                {0.0, kInPercent},
                {0.0, kInPercent},
                {},
                {},
                "line"});
  return figure;
}

}  // namespace

nlohmann::ordered_json sigma_figures(const SigmaReport& report) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const Figure& figure : {pit_figure(report), coverage_figure(report)})
    if (!figure.series.empty()) figures.push_back(to_json(figure));
  return figures;
}

}  // namespace beamgyro::internal
