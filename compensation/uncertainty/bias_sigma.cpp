// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/bias_sigma.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace beamgyro::internal {
namespace {

double time_constant_of(const std::optional<SigmaTerm>& term) {
  return term ? term->time_constant : kSigmaTimeConstant;
}

}  // namespace

double BiasSigma::curve_at(double temperature) const {
  const Eigen::ArrayXd& T = curve.temperatures;
  const double below = T(0) - temperature;
  const double above = temperature - T(T.size() - 1);
  return std::hypot(curve.at(temperature), growth[0] * std::max(below, 0.0),
                    growth[1] * std::max(above, 0.0));
}

double BiasSigma::at(double temperature, double since_power_on,
                     double temperature_rate_K_per_s) const {
  return factor *
         std::hypot(curve_at(temperature),
                    power_on ? power_on->amplitude * since_power_on : 0.0,
                    temperature_rate
                        ? temperature_rate->amplitude * temperature_rate_K_per_s
                        : 0.0);
}

std::vector<Input> BiasSigma::inputs() const {
  return {{InputKind::kColumn, "temperature", 0.0},
          {InputKind::kSincePowerOn, "", time_constant_of(power_on)},
          {InputKind::kTemperatureRate, "temperature",
           time_constant_of(temperature_rate)}};
}

BiasSigmaStream::BiasSigmaStream(BiasSigma sigma)
    : sigma_(std::move(sigma)),
      features_(sigma_.inputs(), kSigmaTemperatures) {}

double BiasSigmaStream::step(double time, std::uint8_t status,
                             double temperature) {
  const std::array<double, 3> measured = {temperature, 0.0, temperature};
  std::array<double, 3> x{};
  if (!features_.step(time, status, measured, x))
    return std::numeric_limits<double>::quiet_NaN();
  return sigma_.at(x[0], x[1], x[2]);
}

std::vector<double> sigma_of(const BiasSigma& sigma,
                             const Recording& recording) {
  const Eigen::ArrayXXd x =
      features_of(sigma.inputs(), recording, kSigmaTemperatures);
  std::vector<double> result(recording.time.size(),
                             std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < result.size(); ++k)
    if ((recording.status[k] & kUnpowered) == 0) {
      const auto row = static_cast<Eigen::Index>(k);
      result[k] = sigma.at(x(row, 0), x(row, 1), x(row, 2));
    }
  return result;
}

BiasStep bias_step(double before, double after, double temperature_change,
                   double correlation) {
  const double distance = std::abs(temperature_change) / correlation;
  return {std::exp(-distance) * after / before,
          -std::expm1(-2.0 * distance) * after * after};
}

double bias_walk_per_kelvin(double sigma, double correlation) {
  return 2.0 * sigma * sigma / correlation;
}

}  // namespace beamgyro::internal
