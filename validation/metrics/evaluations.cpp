// SPDX-License-Identifier: MIT
#include "validation/metrics/evaluations.h"

namespace beamgyro::evaluation {

std::optional<Estimate> bias(const Evidence&) { return {}; }
std::optional<Estimate> bias_pp(const Evidence&) { return {}; }
std::optional<Estimate> bias_sigma(const Evidence&) { return {}; }
std::optional<Estimate> bias_sensitivity(const Evidence&) { return {}; }
std::optional<Estimate> bias_sensitivity_max(const Evidence&) { return {}; }
std::optional<Estimate> residual_mean(const Evidence&) { return {}; }
std::optional<Estimate> residual_sigma(const Evidence&) { return {}; }
std::optional<Estimate> residual_rms(const Evidence&) { return {}; }
std::optional<Estimate> residual_max(const Evidence&) { return {}; }
std::optional<Estimate> residual_pp(const Evidence&) { return {}; }
std::optional<Estimate> normalised_residual(const Evidence&) { return {}; }
std::optional<Estimate> hysteresis_max(const Evidence&) { return {}; }
std::optional<Estimate> hysteresis_rms(const Evidence&) { return {}; }
std::optional<Estimate> soak_hysteresis_max(const Evidence&) { return {}; }
std::optional<Estimate> turn_on_time(const Evidence&) { return {}; }
std::optional<Estimate> warm_up_time(const Evidence&) { return {}; }
std::optional<Estimate> turn_on_repeatability(const Evidence&) { return {}; }
std::optional<Estimate> in_run_stability(const Evidence&) { return {}; }
std::optional<Estimate> power_on_drift_3_min(const Evidence&) { return {}; }
std::optional<Estimate> heading_error_1_min(const Evidence&) { return {}; }
std::optional<Estimate> heading_error_10_min(const Evidence&) { return {}; }
std::optional<Estimate> scale_factor(const Evidence&) { return {}; }
std::optional<Estimate> scale_factor_error(const Evidence&) { return {}; }
std::optional<Estimate> scale_factor_nonlinearity(const Evidence&) {
  return {};
}
std::optional<Estimate> scale_factor_asymmetry(const Evidence&) { return {}; }
std::optional<Estimate> scale_factor_temperature_sensitivity(const Evidence&) {
  return {};
}
std::optional<Estimate> scale_factor_retained(const Evidence&) { return {}; }
std::optional<Estimate> scale_factor_retained_small(const Evidence&) {
  return {};
}
std::optional<Estimate> angle_random_walk(const Evidence&) { return {}; }
std::optional<Estimate> bias_instability(const Evidence&) { return {}; }
std::optional<Estimate> rate_random_walk(const Evidence&) { return {}; }
std::optional<Estimate> rate_ramp(const Evidence&) { return {}; }
std::optional<Estimate> quantisation(const Evidence&) { return {}; }
std::optional<Estimate> lowest_allan_deviation(const Evidence&) { return {}; }
std::optional<Estimate> white_noise_ratio(const Evidence&) { return {}; }
std::optional<Estimate> bandwidth(const Evidence&) { return {}; }
std::optional<Estimate> phase_lag_90(const Evidence&) { return {}; }
std::optional<Estimate> added_delay(const Evidence&) { return {}; }
std::optional<Estimate> g_sensitivity_x(const Evidence&) { return {}; }
std::optional<Estimate> g_sensitivity_y(const Evidence&) { return {}; }
std::optional<Estimate> g_sensitivity_z(const Evidence&) { return {}; }
std::optional<Estimate> vibration_rectification(const Evidence&) { return {}; }
std::optional<Estimate> cross_axis(const Evidence&) { return {}; }
std::optional<Estimate> extrapolated_share(const Evidence&) { return {}; }

}  // namespace beamgyro::evaluation
