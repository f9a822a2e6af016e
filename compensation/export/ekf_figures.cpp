// SPDX-License-Identifier: MIT
#include "compensation/export/ekf_figures.h"

#include <cmath>

#include "compensation/uncertainty/bias_sigma.h"

namespace beamgyro::internal {
namespace {

constexpr int kGrid = 1000;  // steps over the temperatures of sigma

// Returns <sigma(T, e, r)^2> [(deg/s)^2], divided by the scale factor as the
// rate is.
double mean_square(const Compensator& c, const EkfSettings& settings,
                   double since_power_on, double temperature_rate) {
  const auto square = [&](double T) {
    const double scale = c.scale_factor ? c.scale_factor->at(T) : 1.0;
    return std::pow(c.sigma->at(T, since_power_on, temperature_rate) / scale,
                    2);
  };
  if (settings.temperature) return square(*settings.temperature);
  const Eigen::ArrayXd& T = c.sigma->curve.temperatures;
  const double low = T(0);
  const double step = (T(T.size() - 1) - low) / kGrid;
  double sum = 0.0;
  for (int k = 0; k <= kGrid; ++k) sum += square(low + step * k);
  return sum / (kGrid + 1);
}

}  // namespace

EkfFigures ekf_figures(const Compensator& c, const RestNoise& noise,
                       const EkfSettings& settings) {
  const double rate = std::abs(settings.temperature_rate);
  const double still = mean_square(c, settings, 0.0, 0.0);
  const double lag = mean_square(c, settings, 0.0, rate) - still;
  const double per_kelvin =
      bias_walk_per_kelvin(std::sqrt(still), settings.correlation);
  const double lag_time = c.sigma->temperature_rate
                              ? c.sigma->temperature_rate->time_constant
                              : kSigmaTimeConstant;
  EkfFigures figures{
      .noise_density = noise.coefficients.angle_random_walk->value,
      .power_on_sigma = std::sqrt(mean_square(c, settings, 1.0, 0.0)),
      .temperature_sigma = std::sqrt(still),
      .base_walk = noise.walk,
      .walk_per_root_kelvin = std::sqrt(per_kelvin),
      .bias_walk = std::sqrt(noise.walk * noise.walk + per_kelvin * rate +
                             2.0 * lag / lag_time),
      .correlation_time = settings.correlation / rate,
      .power_on_time = {}};
  if (c.sigma->power_on)
    figures.power_on_time = c.sigma->power_on->time_constant;
  return figures;
}

}  // namespace beamgyro::internal
