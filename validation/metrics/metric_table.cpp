// SPDX-License-Identifier: MIT
#include <algorithm>

#include "validation/metrics/evaluations.h"
#include "validation/metrics/metric.h"

namespace beamgyro::internal {
namespace {

std::vector<Metric> made_table() {
  using enum RunPurpose;

  // Runs without a rate or with one that is held for minutes.
  const std::vector<RunPurpose> kQuiet = {kSoak,       kRamp, kWarmUp,
                                          kPowerCycle, kRest, kConstantRate};
  const std::vector<RunPurpose> kPowerOns = {kWarmUp, kPowerCycle};
  const std::vector<RunPurpose> kStarts = {kWarmUp, kPowerCycle, kRateStep};
  const std::vector<RunPurpose> kTurning = {kRateTable, kSineRate, kRateStep,
                                            kRandomRate};
  const std::vector<RunPurpose> kSwings = {kSineRate, kRateStep, kRandomRate};
  const std::vector<RunPurpose> kEvery = {
      kSoak,     kRamp,     kWarmUp, kPowerCycle, kRateTable,  kConstantRate,
      kSineRate, kRateStep, kRest,   kTumble,     kRandomRate, kVibration};

  return {
      {"bias_deg_per_s",
       "deg/s",
       "12.11",
       "Mean of the residual (judged rate less true rate) over runs at "
       "rest.",
       {kRest},
       &evaluation::bias},
      {"bias_pp_deg_per_s",
       "deg/s",
       "12.11",
       "max B(T_j) - min B(T_j): B(T_j) is the mean residual over the "
       "last 300 s of soak j.",
       {kSoak},
       &evaluation::bias_pp},
      {"bias_sigma_deg_per_s",
       "deg/s",
       "12.11",
       "Standard deviation of the B(T_j) about their mean, divided by "
       "their number n.",
       {kSoak},
       &evaluation::bias_sigma},
      {"bias_sensitivity_deg_per_s_per_K",
       "deg/s/K",
       "12.11",
       "Slope of the least-squares line of B(T_j) over the measured "
       "temperature T_j.",
       {kSoak},
       &evaluation::bias_sensitivity},
      {"bias_sensitivity_max_deg_per_s_per_K",
       "deg/s/K",
       "12.11",
       "max |B(T_j+1) - B(T_j-1)| / |T_j+1 - T_j-1| over the soaks in "
       "order of temperature.",
       {kSoak},
       &evaluation::bias_sensitivity_max},
      {"residual_mean_deg_per_s", "deg/s", "",
       "Mean of the residual over blocks of 60 s: r_i is the mean of a "
       "block.",
       kQuiet, &evaluation::residual_mean},
      {"residual_sigma_deg_per_s", "deg/s", "",
       "sqrt(sum (r_i - mean)^2 / n) over the blocks of 60 s.", kQuiet,
       &evaluation::residual_sigma},
      {"residual_rms_deg_per_s", "deg/s", "",
       "sqrt(sum r_i^2 / n) over the blocks of 60 s.", kQuiet,
       &evaluation::residual_rms},
      {"residual_max_deg_per_s", "deg/s", "",
       "max |r_i| over the blocks of 60 s.", kQuiet, &evaluation::residual_max},
      {"residual_pp_deg_per_s", "deg/s", "",
       "max r_i - min r_i over the blocks of 60 s.", kQuiet,
       &evaluation::residual_pp},
      {"normalised_residual", "1", "",
       "sqrt(mean r_i^2 / s_i^2) over the blocks of 60 s: s_i is the "
       "standard deviation of a block's mean under the noise that the "
       "device states. 1: the noise explains what is left.",
       kQuiet, &evaluation::normalised_residual},
      {"hysteresis_max_deg_per_s",
       "deg/s",
       "",
       "max over T of |B_up(T) - B_down(T)| at the same measured "
       "temperature, between ramps of equal slope.",
       {kRamp},
       &evaluation::hysteresis_max},
      {"hysteresis_rms_deg_per_s",
       "deg/s",
       "",
       "rms over T of B_up(T) - B_down(T) at the same measured "
       "temperature, between ramps of equal slope.",
       {kRamp},
       &evaluation::hysteresis_rms},
      {"soak_hysteresis_max_deg_per_s",
       "deg/s",
       "",
       "max |B_up(T_j) - B_down(T_j)| between soaks at one ambient "
       "temperature that were reached from below and from above.",
       {kSoak},
       &evaluation::soak_hysteresis_max},
      {"turn_on_time_s", "s", "12.5",
       "Longest time from power-on until the loops stay locked. Not of "
       "a quasi-static run, which has no start-up.",
       kStarts, &evaluation::turn_on_time},
      {"warm_up_time_s",
       "s",
       "12.6",
       "Longest time from power-on after which |B(t) - B_end| stays "
       "within the greater of 5 % of |B(0) - B_end| and 3 sigma of the "
       "noise of that difference.",
       {kWarmUp},
       &evaluation::warm_up_time},
      {"turn_on_repeatability_deg_per_s",
       "deg/s",
       "12.11",
       "sqrt(sum (B_i - mean)^2 / (n - 1)): B_i is the mean residual of "
       "power cycle i over the same time from power-on, pooled over "
       "runs.",
       {kPowerCycle},
       &evaluation::turn_on_repeatability},
      {"in_run_stability_deg_per_s",
       "deg/s",
       "12.11",
       "sqrt(sum (b_i - mean)^2 / (n - 1)) of the means b_i of 100 s "
       "over the last hour of a run at rest, pooled over runs.",
       {kRest},
       &evaluation::in_run_stability},
      {"power_on_drift_3_min_deg_per_s", "deg/s", "",
       "Largest |b(t) - b(0)| within 3 min from power-on: b are means "
       "of 10 s, b(0) the first one, with which the user zeroes the "
       "gyro.",
       kPowerOns, &evaluation::power_on_drift_3_min},
      {"heading_error_1_min_deg", "deg", "",
       "Largest |integral of the residual over 1 min|, from 10 s after "
       "power-on, less the mean of those 10 s, with which the user "
       "zeroes the gyro.",
       kPowerOns, &evaluation::heading_error_1_min},
      {"heading_error_10_min_deg", "deg", "",
       "Largest |integral of the residual over 10 min|, from 10 s after "
       "power-on, less the mean of those 10 s, with which the user "
       "zeroes the gyro.",
       kPowerOns, &evaluation::heading_error_10_min},
      {"scale_factor",
       "1",
       "12.9",
       "Slope K of the least-squares line of the judged rate over the "
       "held true rates, mean over the rate tables.",
       {kRateTable},
       &evaluation::scale_factor},
      {"scale_factor_error_ppm",
       "ppm",
       "12.9",
       "max |K_j - 1| over the rate tables.",
       {kRateTable},
       &evaluation::scale_factor_error},
      {"scale_factor_nonlinearity_ppm",
       "ppm",
       "12.9",
       "max |V_i - line| / (K max |Omega_i|): V_i is the mean answer to "
       "the held rate Omega_i; of the worst rate table.",
       {kRateTable},
       &evaluation::scale_factor_nonlinearity},
      {"scale_factor_asymmetry_ppm",
       "ppm",
       "12.9",
       "2 (K+ - K-) / (K+ + K-) of the slopes over the rates >= 0 and "
       "<= 0; of the table where it is largest.",
       {kRateTable},
       &evaluation::scale_factor_asymmetry},
      {"scale_factor_temperature_sensitivity_ppm_per_K",
       "ppm/K",
       "12.9",
       "Slope of the least-squares line of K_j over the measured "
       "temperature T_j, divided by the line at 25 degC.",
       {kRateTable},
       &evaluation::scale_factor_temperature_sensitivity},
      {"scale_factor_retained", "1", "",
       "Slope of the judged rate over the true rate divided by that of "
       "the recorded rate, on the same samples.",
       kTurning, &evaluation::scale_factor_retained},
      {"scale_factor_retained_small_rates", "1", "",
       "scale_factor_retained over samples whose true rate is within 2 deg/s.",
       kTurning, &evaluation::scale_factor_retained_small},
      {"angle_random_walk_deg_per_sqrt_h",
       "deg/sqrt(h)",
       "12.11",
       "N, white noise, of the fit sigma^2(tau) = 3 Q^2/tau^2 + N^2/tau + "
       "(2 ln 2/pi) B^2 + K^2 tau/3 + R^2 tau^2/2 to the overlapping Allan "
       "deviations.",
       {kRest},
       &evaluation::angle_random_walk},
      {"bias_instability_deg_per_h",
       "deg/h",
       "12.11",
       "B, flicker, of the fit of angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       &evaluation::bias_instability},
      {"rate_random_walk_deg_per_h_per_sqrt_h",
       "deg/h/sqrt(h)",
       "12.11",
       "K, random walk of the rate, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       &evaluation::rate_random_walk},
      {"rate_ramp_deg_per_h_per_h",
       "deg/h/h",
       "12.11",
       "R, steady change of the rate, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       &evaluation::rate_ramp},
      {"quantisation_deg",
       "deg",
       "12.11",
       "Q, rounding of the angle, of the fit of "
       "angle_random_walk_deg_per_sqrt_h.",
       {kRest},
       &evaluation::quantisation},
      {"bias_instability_bound_deg_per_h",
       "deg/h",
       "12.11",
       "Lowest overlapping Allan deviation over sqrt(2 ln 2/pi) = "
       "0.664: the bias instability, or what lies above it.",
       {kRest},
       &evaluation::lowest_allan_deviation},
      {"white_noise_ratio",
       "1",
       "",
       "Allan deviation at 1 s of the judged residual over that of the "
       "recorded one. Below 1: noise was removed, and rate with it.",
       {kRest},
       &evaluation::white_noise_ratio},
      {"bandwidth_Hz", "Hz", "12.15",
       "Frequency at which |H(f)|, judged rate over true rate, falls 3 dB "
       "below its value at the lowest frequency.",
       kSwings, &evaluation::bandwidth},
      {"phase_lag_90_deg_Hz", "Hz", "12.15",
       "Frequency at which the phase of H(f) lags by 90 degrees.", kSwings,
       &evaluation::phase_lag_90},
      {"added_delay_s", "s", "",
       "Delay of the judged rate after the recorded rate, from the "
       "phase between them.",
       kSwings, &evaluation::added_delay},
      {"g_sensitivity_x_deg_per_s_per_g",
       "deg/s/g",
       "",
       "(B(+g) - B(-g)) / 2 along x: slope of the least-squares plane "
       "of the residual over the acceleration.",
       {kTumble},
       &evaluation::g_sensitivity_x},
      {"g_sensitivity_y_deg_per_s_per_g",
       "deg/s/g",
       "",
       "g_sensitivity_x_deg_per_s_per_g, but along y.",
       {kTumble},
       &evaluation::g_sensitivity_y},
      {"g_sensitivity_z_deg_per_s_per_g",
       "deg/s/g",
       "",
       "g_sensitivity_x_deg_per_s_per_g, but along z.",
       {kTumble},
       &evaluation::g_sensitivity_z},
      {"vibration_rectification_deg_per_s_per_g2",
       "deg/s/g^2",
       "",
       "Slope of the residual over the mean square of the acceleration, "
       "beside its mean.",
       {kVibration},
       &evaluation::vibration_rectification},
      {"cross_axis_percent",
       "%",
       "12.12",
       "Largest slope of the residual over the true rate about a cross "
       "axis.",
       {kVibration},
       &evaluation::cross_axis},
      {"extrapolated_share_percent", "%", "",
       "Samples outside what training saw, of all powered samples.", kEvery,
       &evaluation::extrapolated_share},
  };
}

// Of the sigma that a compensator states for its rate.
std::vector<Metric> sigma_table() {
  using enum RunPurpose;
  const std::vector<RunPurpose> kTemperature = {kSoak, kRamp};
  const auto share = [&](std::string_view name, std::string_view definition,
                         std::optional<Estimate> (*evaluate)(const Evidence&)) {
    return Metric{name, "%", "", definition, kTemperature, evaluate, true};
  };
  return {
      share("sigma_coverage_50_soaks_percent",
            "Soaks whose mean residual over the last 300 s lies within 0.674 "
            "of the stated sigma, those of each 10 K counted as one: 50 for a "
            "sigma that is right.",
            &evaluation::soak_coverage_50),
      share("sigma_coverage_90_soaks_percent",
            "sigma_coverage_50_soaks_percent, but within 1.645 sigma: 90 for a "
            "sigma that is right.",
            &evaluation::soak_coverage_90),
      share("sigma_coverage_95_soaks_percent",
            "sigma_coverage_50_soaks_percent, but within 1.960 sigma: 95 for a "
            "sigma that is right.",
            &evaluation::soak_coverage_95),
      share("sigma_coverage_50_ramps_percent",
            "Blocks of 60 s at a moving temperature whose mean residual lies "
            "within 0.674 of the stated sigma, those of each 10 K counted as "
            "one.",
            &evaluation::ramp_coverage_50),
      share("sigma_coverage_90_ramps_percent",
            "sigma_coverage_50_ramps_percent, but within 1.645 sigma.",
            &evaluation::ramp_coverage_90),
      share("sigma_coverage_95_ramps_percent",
            "sigma_coverage_50_ramps_percent, but within 1.960 sigma.",
            &evaluation::ramp_coverage_95),
      {"sigma_pit_distance_soaks", "1", "",
       "max |F(u) - u|: F(u) is the share of the soaks with Phi(residual / "
       "sigma) <= u.",
       kTemperature, &evaluation::soak_pit_distance, true},
      {"sigma_pit_distance_ramps", "1", "",
       "max |F(u) - u| of the blocks at a moving temperature, those of each 10 "
       "K counted as one.",
       kTemperature, &evaluation::ramp_pit_distance, true},
      {"bias_filter_nis",
       "1",
       "",
       "Mean normalised innovation squared of a Kalman filter for the bias "
       "that believes the stated sigma and measures the residual over 1 s at "
       "power-on and every 25 K: 1 for a sigma that is right.",
       {kSoak, kRamp, kWarmUp, kPowerCycle},
       &evaluation::bias_filter_nis,
       true},
  };
}

std::vector<Metric> whole_table() {
  std::vector<Metric> all = made_table();
  const std::vector<Metric> more = sigma_table();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

std::span<const Metric> metrics() {
  static const std::vector<Metric> kMetrics = whole_table();
  return kMetrics;
}

const Metric* find_metric(std::string_view name) {
  const std::span<const Metric> all = metrics();
  const auto found = std::ranges::find(all, name, &Metric::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace beamgyro::internal
