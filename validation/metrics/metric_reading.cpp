// SPDX-License-Identifier: MIT
#include "validation/metrics/metric_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace beamgyro::internal {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// What the name and the unit of a metric do not tell.
struct MetricReading {
  std::string_view name, title;  // an empty title: made of the name
  double best = 0.0;             // value, in the unit of the metric
};
constexpr std::array kReadings{
    MetricReading{"bias_pp_deg_per_s", "Peak-to-peak bias"},
    MetricReading{"bias_sigma_deg_per_s", "Standard deviation of the bias"},
    MetricReading{"bias_sensitivity_deg_per_s_per_K",
                  "Bias sensitivity to temperature"},
    MetricReading{"bias_sensitivity_max_deg_per_s_per_K",
                  "Largest bias sensitivity to temperature"},
    MetricReading{"residual_mean_deg_per_s", "Mean residual"},
    MetricReading{"residual_sigma_deg_per_s",
                  "Standard deviation of the residual"},
    MetricReading{"residual_rms_deg_per_s", "Rms of the residual"},
    MetricReading{"residual_max_deg_per_s", "Largest residual"},
    MetricReading{"residual_pp_deg_per_s", "Peak-to-peak residual"},
    MetricReading{"normalised_residual", "Residual relative to its noise"},
    MetricReading{"hysteresis_max_deg_per_s", "Largest hysteresis of ramps"},
    MetricReading{"hysteresis_rms_deg_per_s", "Rms hysteresis of ramps"},
    MetricReading{"soak_hysteresis_max_deg_per_s",
                  "Largest hysteresis of soaks"},
    MetricReading{"in_run_stability_deg_per_s", "In-run bias stability"},
    MetricReading{"turn_on_repeatability_deg_per_s",
                  "Turn-on bias repeatability"},
    MetricReading{"turn_on_time_s", "Turn-on time"},
    MetricReading{"warm_up_time_s", "Warm-up time"},
    MetricReading{"power_on_drift_3_min_deg_per_s",
                  "Drift within 3 min of power-on"},
    MetricReading{"heading_error_1_min_deg", "Heading error after 1 min"},
    MetricReading{"heading_error_10_min_deg", "Heading error after 10 min"},
    MetricReading{"scale_factor", "", 1.0},
    MetricReading{"scale_factor_temperature_sensitivity_ppm_per_K",
                  "Scale factor sensitivity to temperature"},
    MetricReading{"scale_factor_retained", "", 1.0},
    MetricReading{"scale_factor_retained_small_rates",
                  "Scale factor retained at small rates", 1.0},
    MetricReading{"bias_instability_bound_deg_per_h",
                  "Upper bound of the bias instability"},
    MetricReading{"white_noise_ratio", "", 1.0},
    MetricReading{"bandwidth_Hz", "", kUnlimited},
    MetricReading{"phase_lag_90_deg_Hz", "Frequency of 90° phase lag",
                  kUnlimited},
    MetricReading{"response_peak_Hz", "Frequency of the response peak",
                  kUnlimited},
    MetricReading{"g_sensitivity_x_deg_per_s_per_g",
                  "Sensitivity to acceleration along x"},
    MetricReading{"g_sensitivity_y_deg_per_s_per_g",
                  "Sensitivity to acceleration along y"},
    MetricReading{"g_sensitivity_z_deg_per_s_per_g",
                  "Sensitivity to acceleration along z"},
    MetricReading{"cross_axis_percent", "Cross-axis sensitivity"},
    MetricReading{"extrapolated_share_percent",
                  "Samples outside the training range"},
    MetricReading{"sigma_coverage_50_soaks_percent",
                  "Soaks within the stated 50 % interval", 50.0},
    MetricReading{"sigma_coverage_90_soaks_percent",
                  "Soaks within the stated 90 % interval", 90.0},
    MetricReading{"sigma_coverage_95_soaks_percent",
                  "Soaks within the stated 95 % interval", 95.0},
    MetricReading{"sigma_coverage_50_ramps_percent",
                  "Ramps within the stated 50 % interval", 50.0},
    MetricReading{"sigma_coverage_90_ramps_percent",
                  "Ramps within the stated 90 % interval", 90.0},
    MetricReading{"sigma_coverage_95_ramps_percent",
                  "Ramps within the stated 95 % interval", 95.0},
    MetricReading{"sigma_pit_distance_soaks",
                  "Distance of soaks from the stated distribution"},
    MetricReading{"sigma_pit_distance_ramps",
                  "Distance of ramps from the stated distribution"},
    MetricReading{"bias_filter_nis",
                  "Normalised innovation squared of a bias filter", 1.0}};

const MetricReading* reading_of(const Metric& metric) {
  const auto* const found =
      std::ranges::find(kReadings, metric.name, &MetricReading::name);
  return found == kReadings.end() ? nullptr : found;
}

// The unit as the names of metrics end in it: "_deg_per_sqrt_h".
std::string ending_of(std::string_view unit) {
  std::string ending = "_";
  for (const char c : unit)
    if (c == '/')
      ending += "_per_";
    else if (c == '%')
      ending += "percent";
    else if (c == '(')
      ending += '_';
    else if (c != ')' && c != '^')
      ending += c;
  return ending;
}

}  // namespace

std::string title_of(const Metric& metric) {
  const MetricReading* reading = reading_of(metric);
  if (reading != nullptr && !reading->title.empty())
    return std::string(reading->title);
  std::string title(metric.name);
  const std::string ending = ending_of(metric.unit);
  if (title.ends_with(ending)) title.resize(title.size() - ending.size());
  std::ranges::replace(title, '_', ' ');
  if (title.front() >= 'a' && title.front() <= 'z')
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
  return title;
}

double shortfall_of(const Metric& metric, double value) {
  const MetricReading* reading = reading_of(metric);
  const double best = reading == nullptr ? 0.0 : reading->best;
  return std::isinf(best) ? -value : std::abs(value - best);
}

}  // namespace beamgyro::internal
