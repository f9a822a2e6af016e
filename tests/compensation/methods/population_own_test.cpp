// SPDX-License-Identifier: MIT
#include "compensation/methods/population_own.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::population_own_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kHills = 8;
const std::vector<Input> kTemperature = {parse_input("temperature")};

// Devices of parabolas, and of eight hills and dips of 12 K at temperatures of
// their own, from -40 to 50 degC.
TrainingRows devices(std::uint32_t first, int count, double height) {
  const std::vector<double> T = every_five_kelvins();
  std::vector<Leg> legs;
  std::vector<double> bias;
  for (int d = 0; d < count; ++d) {
    const auto c = white(3 + 2 * kHills, first + static_cast<std::uint32_t>(d));
    legs.push_back({d, d, T.front(), T.back(), static_cast<int>(T.size())});
    for (const double t : T) {
      bias.push_back(c[0] + 0.03 * c[1] * t + 5e-4 * c[2] * t * t);
      for (std::size_t hill = 0; hill < std::size_t{kHills}; ++hill) {
        const double place = 5.0 + 60.0 * std::sin(20.0 * c[3 + 2 * hill]);
        bias.back() += height * c[4 + 2 * hill] *
                       std::exp(-std::pow((t - place) / 12.0, 2));
      }
    }
  }
  return rows_of(
      legs, [&](double, int k) { return bias[static_cast<std::size_t>(k)]; });
}

Population learned(std::uint32_t first, int count, double height) {
  Population p =
      fit_population(kTemperature, devices(first, count, height), 5.0);
  p.own = learned_own_parts(p);
  return p;
}

// Mean squares of the errors, and of the errors over the deviation, of further
// devices from five soaks of theirs.
struct Errors {
  double square = 0.0, score = 0.0;
};
Errors errors_of(const Population& p, double height) {
  constexpr int kDevices = 200;
  const TrainingRows all = devices(5000, kDevices, height);
  const PointNoise noise{p.point_noise};
  Errors found;
  for (int d = 0; d < kDevices; ++d) {
    const TrainingRows own = selected(all, all.device == d);
    const RowMask soaks =
        (own.temperature / 20.0 - (own.temperature / 20.0).round()).abs() <
        0.01;
    const AdaptedBias b =
        adapted_bias(p, kTemperature, selected(own, soaks), noise);
    const ArrayXd error = own.bias - b.mean;
    found.square += error.square().mean() / kDevices;
    found.score +=
        (error.square() / (b.deviation.square() + noise.bias * noise.bias))
            .mean() /
        kDevices;
  }
  return found;
}

TEST(PopulationOwnParts, AreModesOfMaternsCovariance) {
  Population p = fit_population(kTemperature, devices(0, 40, 0.0), 5.0);
  p.own = {{0.5, 12.0}};
  const MatrixXd modes = all_modes(p);
  ASSERT_EQ(modes.cols(), p.modes.cols() + p.grid());
  EXPECT_EQ(modes.leftCols(p.modes.cols()), p.modes);
  const MatrixXd own = modes.rightCols(p.grid());
  const MatrixXd covariance = own * own.transpose();
  for (Index i = 0; i < p.grid(); ++i)
    for (Index j = 0; j < p.grid(); ++j) {
      const double x = std::sqrt(3.0) *
                       std::abs(p.temperatures(i) - p.temperatures(j)) / 12.0;
      EXPECT_NEAR(covariance(i, j), 0.25 * (1.0 + x) * std::exp(-x), 1e-12);
    }
}

TEST(PopulationOwnParts, DevicesOfOneFamilyHaveNone) {
  for (const int count : {40, 200})
    EXPECT_TRUE(learned(0, count, 0.0).own.empty());
}

TEST(PopulationOwnParts, AreFoundInDevicesWithHillsOfTheirOwn) {
  const double height = 1.0;
  Population p = learned(0, 40, height);
  ASSERT_EQ(p.own.size(), 1);
  EXPECT_GT(p.own[0].deviation, 0.1);
  EXPECT_LE(p.own[0].length_K, 20.0);
  const Errors with = errors_of(p, height);
  p.own.clear();
  const Errors without = errors_of(p, height);
  // Forty devices do not show where hills of a further one may be.
  EXPECT_LT(with.square, without.square);
  EXPECT_LT(with.score, 2.0);
  EXPECT_GT(without.score, 2.0 * with.score);
}

TEST(PopulationOwnParts, TellNothingOfTooFewDevices) {
  EXPECT_TRUE(learned(0, kLeastForOwnParts - 1, 1.0).own.empty());
}

TEST(PopulationOwnParts, NoiseOfAPointIsASmallShareOfTheDrift) {
  const Population p = fit_population(kTemperature, devices(0, 40, 0.0), 5.0);
  EXPECT_EQ(usual_point_noise(p), 0.03);
  EXPECT_EQ(usual_run_noise(p), 0.036);
  Population small = p;
  small.modes *= 0.01;
  const MatrixXd bias = small.modes.topRows(small.grid());
  const double drift =
      std::sqrt((bias.rowwise() - bias.colwise().mean()).squaredNorm() /
                static_cast<double>(small.grid()));
  EXPECT_NEAR(usual_point_noise(small), 0.15 * drift, 1e-12);
  EXPECT_EQ(usual_run_noise(small), usual_point_noise(small));
}

}  // namespace
}  // namespace beamgyro::internal::population_own_test
