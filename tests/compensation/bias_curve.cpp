// SPDX-License-Identifier: MIT
#include "tests/compensation/bias_curve.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace beamgyro::internal {
namespace {

constexpr double kOmega = 2.0 * std::numbers::pi * 9156.0;  // [rad/s]

std::complex<double> power_of(double relaxation_time, double exponent) {
  return std::pow(std::complex<double>(0.0, kOmega * relaxation_time),
                  exponent);
}

}  // namespace

double bias_curve(double temperature) {
  const double above_glass = temperature + 48.0;  // [K]
  const std::complex<double> m = power_of(
      std::pow(10.0, 2.0 - 17.44 * above_glass / (51.6 + above_glass)), 0.5);
  const double activation =
      65e3 / 8.314462618 * (1.0 / (temperature + 273.15) - 1.0 / 213.15);
  const std::complex<double> b =
      power_of(std::exp(activation) / (2.0 * std::numbers::pi), 0.45);
  const std::complex<double> mount = m / (1.0 + m), bond = 1.0 / (1.0 + b);
  const double s = temperature / 50.0;
  return 5.36 - 0.95 * s - 0.58 * s * s - 0.88 * mount.real() +
         11.22 * mount.imag() + 25.95 * bond.imag();
}

Eigen::ArrayXd bias_curve(const Eigen::ArrayXd& temperature) {
  return temperature.unaryExpr([](double T) { return bias_curve(T); });
}

Eigen::ArrayXd grid(double low, double high, double step) {
  const auto count =
      static_cast<Eigen::Index>(std::lround((high - low) / step)) + 1;
  return Eigen::ArrayXd::LinSpaced(count, low, high);
}

ScaledRows curve_rows(const Eigen::ArrayXd& temperature, double noise,
                      std::uint32_t run) {
  RandomStream random(11, 0, run, RandomPurpose{0});
  ScaledRows rows{(temperature - 5.0) / 45.0, bias_curve(temperature)};
  for (double& label : rows.target) label += noise * random.normal();
  rows.target = (rows.target - 2.4) / kCurveUnit;
  return rows;
}

}  // namespace beamgyro::internal
