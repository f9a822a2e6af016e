// SPDX-License-Identifier: MIT
#include "compensation/methods/population_membership.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "linear_algebra/linear_systems.h"
#include "random/random_stream.h"
#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::population_membership_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDevices = 40;
const std::vector<Input> kTemperature = {parse_input("temperature")};
const PointNoise kNoise{0.05, 0.01};

// Lines and parabolas with normal coefficients, of device number 0, 1, ...
std::vector<double> device_bias(std::uint32_t number,
                                const std::vector<double>& temperatures) {
  const std::vector<double> c = white(3, number);
  std::vector<double> bias;
  for (const double T : temperatures)
    bias.push_back(c[0] + 0.03 * c[1] * T + 5e-4 * c[2] * T * T);
  return bias;
}

// Rows of devices first, first + 1, ... but for `but`, each from -40 to 50
// degC.
TrainingRows device_rows(std::uint32_t first, int count, int but = -1) {
  const std::vector<double> temperatures = every_five_kelvins();
  std::vector<Leg> legs;
  std::vector<double> bias;
  for (int d = 0, own = 0; d < count; ++d) {
    if (d == but) continue;
    legs.push_back({own, own, temperatures.front(), temperatures.back(),
                    static_cast<int>(temperatures.size())});
    ++own;
    const auto one =
        device_bias(first + static_cast<std::uint32_t>(d), temperatures);
    bias.insert(bias.end(), one.begin(), one.end());
  }
  return rows_of(
      legs, [&](double, int k) { return bias[static_cast<std::size_t>(k)]; });
}

Population population_of(std::uint32_t first, int but = -1) {
  return fit_population(kTemperature, device_rows(first, kDevices, but), 5.0);
}

Membership compared(const Population& population, const TrainingRows& rows) {
  return membership(population, kTemperature, rows, kNoise).value();
}

// By how much the bias changes over a kelvin of a device that is adapted to
// rows.
VectorXd slope(const Population& p, const TrainingRows& rows) {
  const CubicSpline curve =
      bias_curve(p, adapted_bias(p, kTemperature, rows, kNoise).mean);
  return (curve.predict(rows.temperature + 0.5) -
          curve.predict(rows.temperature - 0.5))
      .matrix();
}

// Phi Phi^T + R of rows at all temperatures of the grid, and the error of the
// beam's temperature.
MatrixXd covariance(const Population& p, const VectorXd& slope) {
  MatrixXd S = p.modes * p.modes.transpose();
  S += std::pow(kBeamTemperatureError, 2) * slope * slope.transpose();
  S.diagonal().array() += kNoise.bias * kNoise.bias;
  return S;
}

// (y - mu)^T S^-1 (y - mu)
double mahalanobis(const Population& p, const TrainingRows& rows,
                   const MatrixXd& S) {
  const VectorXd y = rows.bias.matrix() - p.mean;
  return y.dot(solve_system(S, y).col(0));
}

TrainingRows with_noise(TrainingRows rows, std::uint32_t number) {
  const std::vector<double> z = white(static_cast<int>(rows.size()), number);
  for (Index k = 0; k < rows.size(); ++k)
    rows.bias(k) += kNoise.bias * z[static_cast<std::size_t>(k)];
  return rows;
}

TEST(PopulationMembership, DistanceIsThatOfMahalanobis) {
  const Population p = population_of(0);
  for (std::uint32_t device = 100; device < 110; ++device) {
    const TrainingRows rows = device_rows(device, 1);
    const Membership found = compared(p, rows);
    EXPECT_NEAR(found.distance,
                mahalanobis(p, rows, covariance(p, slope(p, rows))),
                1e-6 * found.distance);
    EXPECT_EQ(found.values, rows.size());
    EXPECT_EQ(found.devices, kDevices);
  }
}

TEST(PopulationMembership, ThresholdIsOfEachDeviceHeldAgainstAllOthers) {
  const Population p = population_of(0);
  const VectorXd common = slope(p, device_rows(0, 1));
  std::vector<double> distances;
  for (int d = 0; d < kDevices; ++d) {
    const Population others = population_of(0, d);
    TrainingRows rows = device_rows(static_cast<std::uint32_t>(d), 1);
    RandomStream noise(0, static_cast<std::uint32_t>(d), 0, kMembershipStream);
    for (double& bias : rows.bias) bias += kNoise.bias * noise.normal();
    distances.push_back(mahalanobis(others, rows, covariance(others, common)));
  }
  std::ranges::sort(distances);
  // ceil(0.96 * 41) = 40: the farthest one. Coefficients have four decimals,
  // and a slope counts as one of the modes, whose covariance is 39/38 of that
  // of all.
  const double threshold = compared(p, device_rows(0, 1)).threshold;
  EXPECT_NEAR(threshold, distances.back(), 1e-3 * threshold);
}

TEST(PopulationMembership, FewDevicesOfTheSameKindAreForeign) {
  constexpr int kPopulations = 10, kFurther = 100;
  int foreign = 0;
  for (std::uint32_t k = 0; k < kPopulations; ++k) {
    const std::uint32_t first = 1000 * (k + 1);
    const Population p = population_of(first);
    for (std::uint32_t d = 0; d < kFurther; ++d)
      foreign += compared(p, with_noise(device_rows(first + kDevices + d, 1),
                                        first + 500 + d))
                     .is_foreign();
  }
  // 1 of 41 by conformal prediction: 24 of 1000.
  EXPECT_GT(foreign, 5);
  EXPECT_LT(foreign, 50);
}

TEST(PopulationMembership, ABumpOfItsOwnIsForeign) {
  const Population p = population_of(0);
  TrainingRows rows = device_rows(100, 1);
  EXPECT_FALSE(compared(p, rows).is_foreign());
  rows.bias += 0.5 * (-((rows.temperature - 10.0) / 4.0).square()).exp();
  EXPECT_TRUE(compared(p, rows).is_foreign());
}

TEST(PopulationMembership, SaysNothingOfTooFewDevicesOrRows) {
  const Population p = population_of(0);
  const TrainingRows rows = device_rows(100, 1);
  EXPECT_FALSE(
      membership(p, kTemperature, selected(rows, rows.bias > 1e9), kNoise));
  EXPECT_FALSE(membership(fit_population(kTemperature, device_rows(0, 23), 5.0),
                          kTemperature, rows, kNoise));
  EXPECT_TRUE(membership(fit_population(kTemperature, device_rows(0, 24), 5.0),
                         kTemperature, rows, kNoise));
}

}  // namespace
}  // namespace beamgyro::internal::population_membership_test
