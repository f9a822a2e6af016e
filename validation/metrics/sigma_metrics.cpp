// SPDX-License-Identifier: MIT
#include <utility>
#include <vector>

#include "validation/metrics/metric_tables.h"
#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"

namespace beamgyro::internal {
namespace {

using Errors = std::vector<ErrorGroup> (*)(const Evidence&);

std::optional<Estimate> covered(const Evidence& evidence, Errors errors,
                                double level) {
  std::optional<Estimate> share = coverage(errors(evidence), level);
  if (!share) return share;
  share->value *= 100.0;
  share->interval->low *= 100.0;
  share->interval->high *= 100.0;
  return share;
}

std::optional<Estimate> distance(const Evidence& evidence, Errors errors) {
  const std::optional<PitReport> report = pit_report(errors(evidence));
  if (!report) return std::nullopt;
  return Estimate{report->distance};
}

std::optional<Estimate> bias_filter_nis(const Evidence& evidence) {
  return mean_normalised(filter_runs(evidence));
}

}  // namespace

std::vector<Metric> sigma_metrics() {
  using enum RunPurpose;
  const std::vector<RunPurpose> kTemperature = {kSoak, kRamp};
  const auto share = [&](std::string_view name, std::string_view title,
                         std::string_view definition, Errors errors,
                         double percent) {
    return Metric{name,
                  title,
                  "%",
                  "",
                  definition,
                  kTemperature,
                  given(covered, errors, percent / 100.0),
                  percent,
                  true};
  };
  return {
      share("sigma_coverage_50_soaks_percent",
            "Soaks within the stated 50 % interval",
            "Soaks whose mean residual over the last 300 s lies within 0.674 "
            "of the stated sigma, those of each 10 K counted as one: 50 for a "
            "sigma that is right.",
            &soak_errors, 50.0),
      share("sigma_coverage_90_soaks_percent",
            "Soaks within the stated 90 % interval",
            "sigma_coverage_50_soaks_percent, but within 1.645 sigma: 90 for a "
            "sigma that is right.",
            &soak_errors, 90.0),
      share("sigma_coverage_95_soaks_percent",
            "Soaks within the stated 95 % interval",
            "sigma_coverage_50_soaks_percent, but within 1.960 sigma: 95 for a "
            "sigma that is right.",
            &soak_errors, 95.0),
      share("sigma_coverage_50_ramps_percent",
            "Ramps within the stated 50 % interval",
            "Blocks of 60 s at a moving temperature whose mean residual lies "
            "within 0.674 of the stated sigma, those of each 10 K counted as "
            "one.",
            &ramp_errors, 50.0),
      share("sigma_coverage_90_ramps_percent",
            "Ramps within the stated 90 % interval",
            "sigma_coverage_50_ramps_percent, but within 1.645 sigma.",
            &ramp_errors, 90.0),
      share("sigma_coverage_95_ramps_percent",
            "Ramps within the stated 95 % interval",
            "sigma_coverage_50_ramps_percent, but within 1.960 sigma.",
            &ramp_errors, 95.0),
      {"sigma_pit_distance_soaks",
       "Distance of soaks from the stated distribution", "1", "",
       "max |F(u) - u|: F(u) is the share of the soaks with Phi(residual / "
       "sigma) <= u.",
       kTemperature, given(distance, &soak_errors), 0.0, true},
      {"sigma_pit_distance_ramps",
       "Distance of ramps from the stated distribution", "1", "",
       "max |F(u) - u| of the blocks at a moving temperature, those of each 10 "
       "K counted as one.",
       kTemperature, given(distance, &ramp_errors), 0.0, true},
      {"bias_filter_nis",
       "Normalised innovation squared of a bias filter",
       "1",
       "",
       "Mean normalised innovation squared of a Kalman filter for the bias "
       "that believes the stated sigma and measures the residual over 1 s at "
       "power-on and every 25 K: 1 for a sigma that is right.",
       {kSoak, kRamp, kWarmUp, kPowerCycle},
       bias_filter_nis,
       1.0,
       true},
  };
}

}  // namespace beamgyro::internal
