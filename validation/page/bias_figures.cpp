// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "validation/evidence/evidence.h"
#include "validation/metrics/segments.h"
#include "validation/metrics/soaks.h"
#include "validation/page/figure_makers.h"
#include "validation/page/figures.h"

namespace beamgyro::internal {
namespace {

/// Means over a block of samples of a run.
struct ResidualMean {
  double since_power_on;  // [s]
  double temperature;     // [degC], measured; NaN without
  double residual;        // [deg/s], judged less true rate
};

/// Returns the means over blocks of `least` [s], or of so many more that there
/// are about kFigurePoints at most. A block with a sample without a rate is
/// left out.
std::vector<ResidualMean> residual_means(const EvidenceRun& run, double least) {
  const auto& time = run.recording->time;
  if (time.empty()) return {};
  const double length =
      std::max(least, std::ceil((time.back() - time.front()) /
                                static_cast<double>(kFigurePoints)));
  const auto segments =
      segments_of(*run.recording, score_blocks(*run.recording, length));
  const std::vector<double> values = means_over(segments, residual_of(run));
  std::vector<ResidualMean> means;
  for (std::size_t k = 0; k < segments.size(); ++k)
    if (std::isfinite(values[k]))
      means.push_back(
          {segments[k].powered, segments[k].temperature, values[k]});
  return means;
}

constexpr double kMinute = 60.0;                 // [s]
constexpr double kWarmUpBlock = 30.0;            // [s]
constexpr double kLeastTemperatureSlope = 0.05;  // [K/min], of a ramp
constexpr int kHistogramBars = 31;

FigureAxis bias_axis() { return {"Rate less true rate", "deg/s"}; }

/// The whole, and the rate after compensation alone.
std::vector<Figure> with_close_up(Figure whole, const std::string& title) {
  std::vector<Figure> figures = close_up(whole, "after", "_after", title);
  figures.insert(figures.begin(), std::move(whole));
  return figures;
}

struct DirectedMean {
  double temperature;  // [degC], measured
  double residual;     // [deg/s]
  bool rising;         // from the one before, or else to the next one
};

void add_by_direction(const std::vector<DirectedMean>& means,
                      const std::string& name, const std::string& role,
                      Figure& figure) {
  FigureSeries rising{name + ", rising", role};
  FigureSeries falling{name + ", falling", role};
  for (const DirectedMean& mean : means)
    (mean.rising ? rising : falling).add(mean.temperature, mean.residual);
  figure.add(std::move(rising));
  figure.add(std::move(falling));
}

std::vector<DirectedMean> soak_means(const EvidenceRun& run) {
  const std::vector<Soak> soaks = soaks_of(*run.recording);
  const auto segments = segments_of(*run.recording, ranges_of(soaks));
  const std::vector<double> residual = means_over(segments, residual_of(run));
  std::vector<DirectedMean> means;
  for (std::size_t k = 0; k < soaks.size(); ++k) {
    const Soak& reached = soaks[k == 0 && soaks.size() > 1 ? 1 : k];
    means.push_back({segments[k].temperature, residual[k],
                     reached.reached != Direction::kDown});
  }
  return means;
}

/// The minutes of a ramp; one without a slope goes on as the one before it.
std::vector<DirectedMean> ramp_means(const EvidenceRun& run) {
  const std::vector<ResidualMean> blocks = residual_means(run, kMinute);
  std::vector<DirectedMean> means;
  for (const ResidualMean& block : blocks)
    means.push_back({block.temperature, block.residual, true});
  std::size_t first = blocks.size();  // with a slope
  for (std::size_t k = 0; k + 1 < blocks.size(); ++k) {
    const double minutes =
        (blocks[k + 1].since_power_on - blocks[k].since_power_on) / kMinute;
    const double move = blocks[k + 1].temperature - blocks[k].temperature;
    if (k > 0) means[k].rising = means[k - 1].rising;
    if (std::abs(move) < kLeastTemperatureSlope * minutes) continue;
    means[k].rising = move > 0.0;
    first = std::min(first, k);
  }
  if (means.size() > 1) means.back().rising = means[means.size() - 2].rising;
  for (std::size_t k = 0; k < first && first < means.size(); ++k)
    means[k].rising = means[first].rising;
  return means;
}

/// Mean over the last tenth of the blocks.
double settled_residual(const std::vector<ResidualMean>& blocks) {
  const std::size_t tenth = std::max<std::size_t>(1, blocks.size() / 10);
  double sum = 0.0;
  for (std::size_t k = blocks.size() - tenth; k < blocks.size(); ++k)
    sum += blocks[k].residual;
  return sum / static_cast<double>(tenth);
}

/// Residuals of every run that is at rest by its purpose.
std::vector<double> residuals_at_rest(const Evidence& evidence) {
  std::vector<double> found;
  for (const EvidenceRun* run :
       runs_for(evidence, {RunPurpose::kSoak, RunPurpose::kRamp,
                           RunPurpose::kWarmUp, RunPurpose::kPowerCycle}))
    for (const ResidualMean& mean : residual_means(*run, kMinute))
      found.push_back(mean.residual);
  return found;
}

struct Spread {
  double mean = 0.0, sigma = 0.0;  // [deg/s]
};

Spread spread_of(const std::vector<double>& values) {
  Spread spread;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) spread.mean += value / n;
  for (const double value : values)
    spread.sigma += (value - spread.mean) * (value - spread.mean) / n;
  spread.sigma = std::sqrt(spread.sigma);
  return spread;
}

}  // namespace

FigureAxis temperature_axis() { return {"Measured temperature", "degC"}; }

std::vector<Figure> bias_over_temperature_figures(
    const ComparedEvidence& both) {
  Figure figure{
      "bias_over_temperature", "Bias over temperature",
      "Means over the last five minutes of each soak. The two "
      "directions differ "
      "by what the temperature sensor does not tell, and by slow noise.",
      temperature_axis(), bias_axis()};
  for_both(both, RunPurpose::kSoak,
           [&](const std::string& role, const EvidenceRun& run) {
             add_by_direction(soak_means(run), role, role, figure);
           });
  return with_close_up(std::move(figure),
                       "Bias over temperature, after compensation");
}

std::vector<Figure> hysteresis_figures(const ComparedEvidence& both) {
  Figure figure{"hysteresis", "Hysteresis loop",
                "Bias while the chamber ramps up and down: a minute's mean at "
                "each point. The loop is open where the gyro lags its "
                "temperature sensor.",
                temperature_axis(), bias_axis()};
  for_both(both, RunPurpose::kRamp,
           [&](const std::string& role, const EvidenceRun& run) {
             add_by_direction(ramp_means(run), role + ", " + run.name, role,
                              figure);
           });
  return with_close_up(std::move(figure),
                       "Hysteresis loop, after compensation");
}

std::vector<Figure> warm_up_figures(const ComparedEvidence& both) {
  Figure figure{"warm_up",
                "Warm-up",
                "Bias since power-on, less its mean over the last tenth of the "
                "run.",
                {"Time since power-on", "min"},
                {"Bias less its final value", "deg/s"}};
  for_both(both, RunPurpose::kWarmUp,
           [&](const std::string& role, const EvidenceRun& run) {
             const auto blocks = residual_means(run, kWarmUpBlock);
             if (blocks.empty()) return;
             const double final_residual = settled_residual(blocks);
             FigureSeries series{
                 fmt::format("{}, {} (from {:.0f} degC)", role, run.name,
                             blocks.front().temperature),
                 role};
             for (const ResidualMean& block : blocks)
               series.add(block.since_power_on / kMinute,
                          block.residual - final_residual);
             figure.add(std::move(series));
           });
  return with_close_up(std::move(figure), "Warm-up, after compensation");
}

std::vector<Figure> residual_histogram_figures(const ComparedEvidence& both) {
  const std::vector<double> values = residuals_at_rest(both.after);
  if (values.size() < 2) return {};
  const auto [least, most] = std::ranges::minmax(values);
  if (!(most > least)) return {};
  const Spread spread = spread_of(values);
  const double width = (most - least) / kHistogramBars;
  std::vector<double> counts(kHistogramBars, 0.0);
  for (const double value : values)
    counts[std::min<std::size_t>(
        kHistogramBars - 1,
        static_cast<std::size_t>((value - least) / width))] += 1.0;
  FigureSeries bars{"after", "after", {}, {}, {}, {}, "bars"};
  FigureSeries normal{"normal distribution of that mean and 1-sigma", "fit"};
  const double percent = 100.0 / static_cast<double>(values.size());
  for (int k = 0; k < kHistogramBars; ++k) {
    const double middle = least + (k + 0.5) * width;
    const double score = (middle - spread.mean) / spread.sigma;
    bars.add(middle, percent * counts[static_cast<std::size_t>(k)]);
    normal.add(middle, 100.0 * width / spread.sigma *
                           std::exp(-0.5 * score * score) /
                           std::sqrt(2.0 * std::numbers::pi));
  }
  Figure figure{"residual_histogram",
                "Residuals at rest, after compensation",
                fmt::format("One-minute means of every run at rest: {} of "
                            "them, mean {:.3g} deg/s, 1-sigma {:.3g} deg/s.",
                            values.size(), spread.mean, spread.sigma),
                {"Compensated less true rate", "deg/s"},
                {"Share of the minutes", "%"},
                "line"};
  figure.add(std::move(bars));
  figure.add(std::move(normal));
  return {std::move(figure)};
}

}  // namespace beamgyro::internal
