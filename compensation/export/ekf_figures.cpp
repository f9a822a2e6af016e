// SPDX-License-Identifier: MIT
#include "compensation/export/ekf_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "compensation/scoring/allan_deviation.h"
#include "compensation/scoring/even_series.h"
#include "compensation/uncertainty/bias_sigma.h"

namespace beamgyro::internal {
namespace {

constexpr double kHeldRate = 1e-9;  // [deg/s]
// Where the Allan deviation of a first-order Gauss-Markov process is largest.
constexpr double kMarkovPeak = 1.893;  // [-], time constants
// Squared Allan deviation of flicker over B^2: 2 ln 2 / pi.
constexpr double kFlickerFloor = 2.0 * std::numbers::ln2 / std::numbers::pi;

// Lowest and highest finite value.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double span() const { return std::max(high - low, 0.0); }
};

Extent extent_of(const std::vector<double>& values) {
  Extent extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    extent.low = std::min(extent.low, value);
    extent.high = std::max(extent.high, value);
  }
  return extent;
}

void require_rest(const Recording& recording) {
  const Column* truth = find_column(recording, "true_rate");
  if (truth == nullptr) return;
  const Extent rate = extent_of(truth->values);
  if (rate.span() > kHeldRate)
    throw std::invalid_argument(fmt::format(
        "true_rate: from {:g} to {:g} deg/s; expected a recording at rest",
        rate.low, rate.high));
}

// The largest random walk that the fitted points leave room for.
double largest_walk(const std::vector<AllanPoint>& points,
                    const std::vector<double>& taus) {
  double least = std::numeric_limits<double>::infinity();
  for (const AllanPoint& point : points)
    if (std::ranges::count(taus, point.tau) > 0)
      least = std::min(least, point.interval.high * std::sqrt(3.0 / point.tau));
  return least;
}

// The middle, of the logarithm, between the taus where the flicker floor is
// left by N and by K. Without K the curve does not show where the floor ends.
std::optional<double> flicker_time_of(const NoiseCoefficients& c) {
  if (!c.bias_instability || !c.rate_random_walk) return std::nullopt;
  const double floor = kFlickerFloor * std::pow(c.bias_instability->value, 2);
  const double begin = std::pow(c.angle_random_walk->value, 2) / floor;
  const double end = 3.0 * floor / std::pow(c.rate_random_walk->value, 2);
  return std::sqrt(begin * std::max(begin, end)) / kMarkovPeak;
}

constexpr int kGrid = 1000;  // steps over the temperatures of sigma

// Returns <sigma(T, e, r)^2> [(deg/s)^2], divided by the scale factor as the
// rate is.
double mean_square(const FittedCompensator& c, const EkfSettings& settings,
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

RestNoise rest_noise(const FittedCompensator& compensator,
                     const Recording& rest) {
  require_rest(rest);
  constexpr const char* kName = "compensated_rate";
  Recording answered;
  answered.time = rest.time;
  answered.status = rest.status;
  answered.columns.push_back({kName, "degree/s", "", Role::kCompensated,
                              compensated_rate(compensator, rest), ""});
  const EvenSeries series = even_series(answered, kName);
  const std::vector<AllanPoint> points =
      allan_curve(series, octave_taus(series)).overlapping;
  if (!has_noise_coefficients(points))
    throw std::invalid_argument(
        fmt::format("{} samples show too little for noise coefficients; "
                    "expected a longer recording at rest, with noise",
                    series.samples));
  RestNoise noise;
  noise.coefficients = noise_coefficients(points);
  const NoiseCoefficients& found = noise.coefficients;
  if (!found.angle_random_walk)
    throw std::invalid_argument(
        "its Allan deviation shows no angle random walk; expected a recording "
        "at rest with a shorter step, or with noise");
  noise.walk_is_bound = !found.rate_random_walk;
  noise.walk = noise.walk_is_bound ? largest_walk(points, found.taus)
                                   : found.rate_random_walk->value;
  noise.flicker_time = flicker_time_of(found);
  noise.sample_rate = 1.0 / series.interval;
  noise.samples = series.samples;
  noise.duration = series.last - series.first;
  if (const Column* temperature = find_column(rest, "temperature"))
    noise.temperature_span = extent_of(temperature->values).span();
  return noise;
}

EkfFigures ekf_figures(const FittedCompensator& c, const RestNoise& noise,
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
