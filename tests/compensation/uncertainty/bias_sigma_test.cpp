// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/bias_sigma.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::bias_sigma_test {
namespace {

constexpr double kRounding = 1e-12;  // of sums of squares of order 1

// s = 0.1 ... 0.3 deg/s over 0 ... 20 degC.
BiasSigma every_term() {
  BiasSigma sigma;
  sigma.curve = {Eigen::ArrayXd{{0.0, 20.0}}, Eigen::ArrayXd{{0.1, 0.3}}};
  sigma.growth = {0.05, 0.4};
  sigma.power_on = SigmaTerm{0.6, 100.0};
  sigma.temperature_rate = SigmaTerm{30.0, 50.0};
  sigma.factor = 2.0;
  return sigma;
}

TEST(BiasSigma, IsTheFactorTimesTheRootOfTheSumOfSquares) {
  const BiasSigma sigma = every_term();
  EXPECT_NEAR(sigma.at(10.0, 0.0, 0.0), 2.0 * 0.2, kRounding);
  EXPECT_NEAR(sigma.at(10.0, 0.5, -0.01),
              2.0 * std::sqrt(0.2 * 0.2 + 0.3 * 0.3 + 0.3 * 0.3), kRounding);
}

TEST(BiasSigma, GrowsOutsideItsTemperaturesWithoutEnd) {
  const BiasSigma sigma = every_term();
  EXPECT_NEAR(sigma.at(-8.0, 0.0, 0.0), 2.0 * std::hypot(0.1, 0.4), kRounding);
  EXPECT_NEAR(sigma.at(23.0, 0.0, 0.0), 2.0 * std::hypot(0.3, 1.2), kRounding);
  double below = sigma.at(0.0, 0.0, 0.0), above = sigma.at(20.0, 0.0, 0.0);
  for (double d = 1.0; d < 1e4; d *= 2.0) {
    const double lower = sigma.at(-d, 0.0, 0.0);
    const double higher = sigma.at(20.0 + d, 0.0, 0.0);
    EXPECT_GT(lower, below);
    EXPECT_GT(higher, above);
    below = lower;
    above = higher;
  }
  EXPECT_GT(below, 500.0);
}

TEST(BiasSigma, IsAsLargeAtEveryPowerOnAndDecaysSince) {
  RecordedRun run{.duration = 1000.0, .step = 1.0};
  run.temperature = [](double) { return 10.0; };
  run.powered = [](double t) { return t < 400.0 || t >= 500.0; };
  const std::vector<double> sigma = sigma_of(every_term(), run.recording());
  EXPECT_NEAR(sigma[0], 2.0 * std::hypot(0.2, 0.6), kRounding);
  EXPECT_NEAR(sigma[100], 2.0 * std::hypot(0.2, 0.6 * std::exp(-1.0)),
              kRounding);
  EXPECT_TRUE(std::isnan(sigma[450]));
  EXPECT_EQ(sigma[500], sigma[0]);
  EXPECT_EQ(sigma[700], sigma[200]);
}

TEST(BiasSigma, TakesTheTemperatureRateOfTheInputOfThatName) {
  RecordedRun run{.duration = 2000.0, .step = 2.0};
  run.temperature = [](double t) { return 5.0 + 0.02 * t; };
  const Recording recording = run.recording();
  BiasSigma sigma = every_term();
  sigma.power_on.reset();
  const std::vector<double> found = sigma_of(sigma, recording);
  const Eigen::ArrayXXd rate =
      features_of({parse_input("temperature_rate(50)")}, recording);
  for (const std::size_t k : {0U, 20U, 100U, 999U}) {
    const double T = 5.0 + 0.02 * recording.time[k];
    const double r = rate(static_cast<Eigen::Index>(k));
    EXPECT_NEAR(found[k], sigma.at(T, 0.0, r), kRounding);
  }
  // Long after the start the filter shows the rate itself.
  EXPECT_NEAR(rate(999), 0.02, 1e-9);
}

TEST(BiasSigma, StreamGivesTheSameBitsSampleBySample) {
  RecordedRun run{.duration = 900.0, .step = 0.7};
  run.temperature = [](double t) { return 30.0 * std::sin(0.01 * t); };
  run.powered = [](double t) { return t < 300.0 || t > 350.0; };
  const Recording recording = run.recording();
  const std::vector<double> all = sigma_of(every_term(), recording);
  const auto& temperature = column_values(recording, "temperature");
  BiasSigmaStream stream(every_term());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double one =
        stream.step(recording.time[k], recording.status[k], temperature[k]);
    if (std::isnan(all[k]))
      EXPECT_TRUE(std::isnan(one));
    else
      EXPECT_EQ(one, all[k]);
  }
}

TEST(BiasSigma, RefusesATemperatureThatIsNotFinite) {
  BiasSigmaStream stream(every_term());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(holds(rejection([&] { stream.step(3.0, 0, nan); }),
                    "temperature is nan at t = 3 s"));
}

TEST(CompensatedRateSigma, IsEmptyWithoutOneAndOverTheScaleFactor) {
  RecordedRun run{.duration = 100.0, .step = 1.0};
  run.temperature = [](double) { return 10.0; };
  const Recording recording = run.recording();
  EXPECT_TRUE(compensated_rate_sigma(spline_compensator(), recording).empty());
  FittedCompensator c = with_sigma(spline_compensator());
  const std::vector<double> plain = compensated_rate_sigma(c, recording);
  EXPECT_EQ(plain, sigma_of(*c.sigma, recording));
  c.scale_factor = LookupTable{Eigen::ArrayXd{{10.0}}, Eigen::ArrayXd{{0.5}}};
  const std::vector<double> halved = compensated_rate_sigma(c, recording);
  EXPECT_EQ(halved[50], plain[50] / 0.5);
}

}  // namespace
}  // namespace beamgyro::internal::bias_sigma_test
