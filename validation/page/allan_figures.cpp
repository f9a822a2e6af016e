// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/noise_coefficients.h"
#include "validation/metrics/segments.h"
#include "validation/page/figure_makers.h"

namespace beamgyro::internal {
namespace {

/// Overlapping Allan deviations of the residual, none without answers.
std::vector<AllanPoint> residual_deviations(const EvidenceRun& run) {
  if (std::ranges::none_of(run.rate, [](double r) { return std::isfinite(r); }))
    return {};
  Recording residual;
  residual.time = run.recording->time;
  residual.status = run.recording->status;
  residual.columns.push_back(
      {"residual", "degree/s", "", Role::kCompensated, residual_of(run)});
  const EvenSeries series = even_series(residual, "residual");
  return allan_curve(series, octave_taus(series)).overlapping;
}

/// A term of IEEE 952 as a line over tau.
struct AllanTerm {
  const char* name;
  double value;     // of the coefficient, 0: missing
  double at_one;    // [-], deviation at 1 s over the coefficient
  double exponent;  // [-], of tau
};

std::array<AllanTerm, 5> allan_terms(const NoiseCoefficients& fit) {
  const auto value = [](const auto& estimate) {
    return estimate ? estimate->value : 0.0;
  };
  return {{{"quantisation", value(fit.angle_quantisation), std::sqrt(3.0), -1},
           {"angle random walk", value(fit.angle_random_walk), 1.0, -0.5},
           {"bias instability", value(fit.bias_instability),
            std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi), 0},
           {"rate random walk", value(fit.rate_random_walk),
            std::sqrt(1.0 / 3.0), 0.5},
           {"rate ramp", value(fit.rate_ramp), std::sqrt(0.5), 1}}};
}

/// The lines of the terms that a curve shows.
std::vector<FigureSeries> allan_lines(const std::string& role,
                                      const std::vector<AllanPoint>& points) {
  std::vector<FigureSeries> lines;
  double floor = points.front().deviation;
  for (const AllanPoint& point : points)
    floor = std::min(floor, point.deviation);
  for (const AllanTerm& term : allan_terms(noise_coefficients(points))) {
    if (term.value == 0.0) continue;
    FigureSeries line{role + ": " + term.name, "fit", {}, {}, {}, {}, "line"};
    for (const AllanPoint& point : points) {
      const double deviation =
          term.value * term.at_one * std::pow(point.tau, term.exponent);
      // A line far below the curve only makes the axis longer.
      if (deviation > 0.3 * floor) line.add(point.tau, deviation);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace

std::vector<Figure> allan_figures(const ComparedEvidence& both) {
  Figure figure{
      "allan",
      "Allan deviation",
      "Overlapping Allan deviation at rest, with the terms that are "
      "fitted to the compensated rate. Whiskers: 95 %, by the type of "
      "noise that each deviation shows.",
      {"Averaging time", "s", true},
      {"Allan deviation", "deg/s", true},
      "points"};
  std::vector<FigureSeries> lines;
  for_both(
      both, RunPurpose::kRest,
      [&](const std::string& role, const EvidenceRun& run) {
        const auto points = residual_deviations(run);
        FigureSeries series{role, role};
        for (const AllanPoint& point : points)
          series.add(point.tau, point.deviation,
                     {point.interval.low, point.interval.high});
        figure.add(std::move(series));
        if (role == "after" && lines.empty() && has_noise_coefficients(points))
          lines = allan_lines(role, points);
      });
  for (FigureSeries& line : lines) figure.add(std::move(line));
  return {std::move(figure)};
}

}  // namespace beamgyro::internal
