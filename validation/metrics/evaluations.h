// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "validation/metrics/metric.h"

/// How each metric of the table is evaluated; metric_table.cpp says what it is.
namespace beamgyro::internal::evaluation {

std::optional<Estimate> bias(const Evidence& evidence);
std::optional<Estimate> bias_pp(const Evidence& evidence);
std::optional<Estimate> bias_sigma(const Evidence& evidence);
std::optional<Estimate> bias_sensitivity(const Evidence& evidence);
std::optional<Estimate> bias_sensitivity_max(const Evidence& evidence);
std::optional<Estimate> residual_mean(const Evidence& evidence);
std::optional<Estimate> residual_sigma(const Evidence& evidence);
std::optional<Estimate> residual_rms(const Evidence& evidence);
std::optional<Estimate> residual_max(const Evidence& evidence);
std::optional<Estimate> residual_pp(const Evidence& evidence);
std::optional<Estimate> normalised_residual(const Evidence& evidence);
std::optional<Estimate> hysteresis_max(const Evidence& evidence);
std::optional<Estimate> hysteresis_rms(const Evidence& evidence);
std::optional<Estimate> soak_hysteresis_max(const Evidence& evidence);
std::optional<Estimate> turn_on_time(const Evidence& evidence);
std::optional<Estimate> warm_up_time(const Evidence& evidence);
std::optional<Estimate> turn_on_repeatability(const Evidence& evidence);
std::optional<Estimate> in_run_stability(const Evidence& evidence);
std::optional<Estimate> power_on_drift_3_min(const Evidence& evidence);
std::optional<Estimate> heading_error_1_min(const Evidence& evidence);
std::optional<Estimate> heading_error_10_min(const Evidence& evidence);
std::optional<Estimate> scale_factor(const Evidence& evidence);
std::optional<Estimate> scale_factor_error(const Evidence& evidence);
std::optional<Estimate> scale_factor_nonlinearity(const Evidence& evidence);
std::optional<Estimate> scale_factor_asymmetry(const Evidence& evidence);
std::optional<Estimate> scale_factor_temperature_sensitivity(
    const Evidence& evidence);
std::optional<Estimate> scale_factor_retained(const Evidence& evidence);
std::optional<Estimate> scale_factor_retained_small(const Evidence& evidence);
std::optional<Estimate> angle_random_walk(const Evidence& evidence);
std::optional<Estimate> bias_instability(const Evidence& evidence);
std::optional<Estimate> rate_random_walk(const Evidence& evidence);
std::optional<Estimate> rate_ramp(const Evidence& evidence);
std::optional<Estimate> quantisation(const Evidence& evidence);
std::optional<Estimate> lowest_allan_deviation(const Evidence& evidence);
std::optional<Estimate> white_noise_ratio(const Evidence& evidence);
std::optional<Estimate> bandwidth(const Evidence& evidence);
std::optional<Estimate> phase_lag_90(const Evidence& evidence);
std::optional<Estimate> added_delay(const Evidence& evidence);
std::optional<Estimate> g_sensitivity_x(const Evidence& evidence);
std::optional<Estimate> g_sensitivity_y(const Evidence& evidence);
std::optional<Estimate> g_sensitivity_z(const Evidence& evidence);
std::optional<Estimate> vibration_rectification(const Evidence& evidence);
std::optional<Estimate> cross_axis(const Evidence& evidence);
std::optional<Estimate> extrapolated_share(const Evidence& evidence);
std::optional<Estimate> soak_coverage_50(const Evidence& evidence);
std::optional<Estimate> soak_coverage_90(const Evidence& evidence);
std::optional<Estimate> soak_coverage_95(const Evidence& evidence);
std::optional<Estimate> ramp_coverage_50(const Evidence& evidence);
std::optional<Estimate> ramp_coverage_90(const Evidence& evidence);
std::optional<Estimate> ramp_coverage_95(const Evidence& evidence);
std::optional<Estimate> soak_pit_distance(const Evidence& evidence);
std::optional<Estimate> ramp_pit_distance(const Evidence& evidence);
std::optional<Estimate> bias_filter_nis(const Evidence& evidence);

}  // namespace beamgyro::internal::evaluation
