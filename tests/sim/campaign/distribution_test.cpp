// SPDX-License-Identifier: MIT
#include "sim/campaign/distribution.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/campaign/draw_plan.h"

namespace beamgyro::internal::distribution_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double phi(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

Distribution normal(double mean, double sigma, double low = -kInfinity,
                    double high = kInfinity) {
  Distribution d;
  d.kind = Distribution::Kind::kNormal;
  d.centre = mean;
  d.sigma = sigma;
  d.low = low;
  d.high = high;
  return d;
}

constexpr std::array<double, 7> kShares = {1e-12, 0.01, 0.3,      0.5,
                                           0.7,   0.99, 1 - 1e-12};

TEST(Distribution, NormalQuantilesInvertTheDistributionFunction) {
  const Distribution d = normal(-60, 4);
  EXPECT_EQ(quantile(d, 0.5), -60);
  for (const double u : kShares)
    EXPECT_NEAR(phi((quantile(d, u) + 60) / 4), u, 1e-14);
}

TEST(Distribution, TruncatedNormalHasTheConditionalDistribution) {
  const Distribution d = normal(1, 2, 0, 2.5);
  const double from = phi(-0.5), to = phi(0.75);
  for (const double u : kShares) {
    const double x = quantile(d, u);
    EXPECT_NEAR((phi((x - 1) / 2) - from) / (to - from), u, 1e-13);
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 2.5);
  }
}

TEST(Distribution, OneEndAloneCutsOneTail) {
  const Distribution d = normal(0, 1, -kInfinity, 0);
  for (const double u : kShares) EXPECT_NEAR(phi(quantile(d, u)), u / 2, 1e-14);
}

TEST(Distribution, EitherSignHasBothWithHalfTheProbability) {
  Distribution d;
  d.kind = Distribution::Kind::kLognormal;
  d.centre = 3e-4;
  d.sigma = 0.6;
  const Distribution magnitude = d;
  d.either_sign = true;
  for (const double u : {0.01, 0.3, 0.7, 0.99}) {
    EXPECT_EQ(quantile(d, 0.5 * u), -quantile(magnitude, u));
    EXPECT_NEAR(quantile(d, 0.5 + 0.5 * u), quantile(magnitude, u), 1e-17);
  }
  EXPECT_GT(quantile(d, 0.5), 0);
}

TEST(Distribution, PoissonWeightsAreThoseOfTheSeriesOfTheExponential) {
  const std::vector<double> weights = poisson_weights(8, 60);
  double sum = 0, mean = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    sum += weights[k];
    mean += static_cast<double>(k) * weights[k];
  }
  EXPECT_NEAR(sum, std::exp(8), 1e-11);
  EXPECT_NEAR(mean / sum, 8, 1e-13);
}

// Beside 1 an upper tail of 1e-9 keeps seven digits, mirrored it keeps all.
TEST(Distribution, TheUpperTailIsAsExactAsTheLower) {
  const Distribution upper = normal(0, 1, 6, 7), lower = normal(0, 1, -7, -6);
  for (const double u : {0.1, 0.5, 0.9})
    EXPECT_DOUBLE_EQ(quantile(upper, u), -quantile(lower, 1 - u));
  const double share = phi(-6) - phi(-7);
  EXPECT_NEAR((phi(-6) - phi(-quantile(upper, 0.25))) / share, 0.25, 1e-9);
  EXPECT_NEAR(share_inside(upper) / share, 1, 1e-12);
}

TEST(Distribution, LognormalIsNormalInItsLogarithm) {
  Distribution d;
  d.kind = Distribution::Kind::kLognormal;
  d.centre = 6e-4;
  d.sigma = 0.35;
  d.low = 0;
  for (const double u : kShares)
    EXPECT_NEAR(phi(std::log(quantile(d, u) / 6e-4) / 0.35), u, 1e-13);
  d.high = 6e-4;
  for (const double u : kShares)
    EXPECT_NEAR(phi(std::log(quantile(d, u) / 6e-4) / 0.35), u / 2, 1e-13);
}

TEST(Distribution, UniformIsLinear) {
  Distribution d;
  d.low = -0.0125;
  d.high = -0.0065;
  EXPECT_DOUBLE_EQ(quantile(d, 0.25), -0.011);
}

TEST(Distribution, ChoicesComeByWeightAndNeverWithWeightZero) {
  const Distribution d = discrete({0, 1, 3, 0});
  EXPECT_EQ(quantile(d, 0x1p-53), 1);
  EXPECT_EQ(quantile(d, 0.2499), 1);
  EXPECT_EQ(quantile(d, 0.2501), 2);
  EXPECT_EQ(quantile(d, 1 - 0x1p-53), 2);
  const Distribution thirds = discrete({0.1, 0.1, 0.1});
  EXPECT_EQ(quantile(thirds, 1 - 0x1p-53), 2);
}

TEST(ParameterUnits, AreWhatTheKeyEndsIn) {
  EXPECT_EQ(units_of("patches.offset_m"), "m");
  EXPECT_EQ(units_of("beam.side_difference"), "1");
  EXPECT_EQ(units_of("mount.axis_angle_deg"), "degree");
  EXPECT_EQ(units_of("bond.beta_1Hz_degC"), "degC");
  EXPECT_EQ(units_of("readout.offset_tc_deg_per_s_per_K"), "degree/s/K");
  EXPECT_EQ(units_of("readout.phase_tc2_rad_per_K2"), "rad/K2");
  EXPECT_EQ(units_of("beam.modulus_tc1_per_K"), "1/K");
  EXPECT_EQ(units_of("noise.angle_random_walk_deg_per_sqrt_s"),
            "degree/sqrt(s)");
  EXPECT_EQ(units_of("noise.rate_random_walk_deg_per_s_per_sqrt_s"),
            "degree/s/sqrt(s)");
  EXPECT_EQ(units_of("beam.specific_heat_J_per_kgK"), "J/(kg K)");
  EXPECT_EQ(units_of("age.hours"), "h");
  EXPECT_EQ(units_of("memory.ageing.trim_age_hours"), "h");
  EXPECT_EQ(units_of("noise.random_walk_correlation_h"), "h");
  EXPECT_EQ(units_of("readout.amplifier_noise_V_per_sqrt_Hz"), "V/sqrt(Hz)");
  EXPECT_EQ(units_of("ambient.soaks.ramp_K_per_min"), "K/min");
  EXPECT_EQ(units_of("readout.mode"), "1");
}

}  // namespace
}  // namespace beamgyro::internal::distribution_test
