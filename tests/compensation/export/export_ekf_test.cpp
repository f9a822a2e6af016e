// SPDX-License-Identifier: MIT
#include "compensation/export/export_ekf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "random/random_stream.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::export_ekf_test {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;  // [rad/deg]
constexpr RandomPurpose kRestNoise{901};

/// sigma of 0.1 deg/s at every temperature, 0.2 more at power-on, 3 deg/s/(K/s)
/// on a ramp, all in squares, times a factor of 2.
FittedCompensator uncertain_compensator() {
  FittedCompensator c = spline_compensator();
  c.sigma = BiasSigma{.curve = {Eigen::ArrayXd::LinSpaced(2, -40.0, 50.0),
                                Eigen::ArrayXd::Constant(2, 0.1)},
                      .growth = {0.01, 0.01},
                      .power_on = SigmaTerm{0.2, 300.0},
                      .temperature_rate = SigmaTerm{3.0, 200.0},
                      .factor = 2.0,
                      .source = SigmaSource::kResiduals,
                      .calibration = {}};
  return c;
}

RestNoise plain_noise() {
  RestNoise noise;
  noise.coefficients.angle_random_walk = CoefficientEstimate{0.01, 1e-4};
  noise.walk = 1e-3;
  noise.sample_rate = 100.0;
  return noise;
}

EkfExport given_export(const EkfSettings& settings = {}) {
  EkfExport given{.name = "z",
                  .axis = 'z',
                  .compensator = {"z.json", "c0"},
                  .rest = {"rest.h5", "0f"},
                  .settings = settings,
                  .noise = plain_noise(),
                  .figures = {}};
  given.figures = ekf_figures(uncertain_compensator(), given.noise, settings);
  return given;
}

FilterParameter parameter(const EkfExport& given, const std::string& name) {
  for (const FilterParameter& p : filter_parameters(given))
    if (p.name == name) return p;
  ADD_FAILURE() << name;
  return {};
}

TEST(EkfFigures, FollowTheirEquations) {
  EkfSettings settings;
  settings.temperature_rate = 0.02;  // [K/s]
  settings.correlation = 8.0;
  const EkfFigures f = given_export(settings).figures;
  EXPECT_DOUBLE_EQ(f.noise_density, 0.01);
  // Means over 1001 temperatures.
  EXPECT_NEAR(f.temperature_sigma, 0.2, 1e-13);
  EXPECT_NEAR(f.power_on_sigma, 2.0 * std::hypot(0.1, 0.2), 1e-13);
  EXPECT_NEAR(f.walk_per_root_kelvin, std::sqrt(2.0 / 8.0) * 0.2, 1e-13);
  // K^2 + 2 0.04 0.02 / 8 + 2 (2 3 0.02)^2 / 200.
  EXPECT_NEAR(f.bias_walk, std::sqrt(1e-6 + 2e-4 + 1.44e-4), 1e-13);
  EXPECT_DOUBLE_EQ(f.correlation_time, 400.0);
  EXPECT_DOUBLE_EQ(f.power_on_time.value(), 300.0);
}

TEST(EkfFigures, ATemperatureBeyondTheTrainingIsLessCertain) {
  EkfSettings settings;
  settings.temperature = 60.0;
  EXPECT_NEAR(given_export(settings).figures.temperature_sigma,
              2.0 * std::hypot(0.1, 0.1), 1e-15);
}

// At rest only the walk of the rest is left.
TEST(EkfFigures, WithoutATemperatureRateTheBaseIsLeft) {
  EkfSettings settings;
  settings.temperature_rate = 0.0;
  const EkfExport given = given_export(settings);
  EXPECT_DOUBLE_EQ(given.figures.bias_walk, 1e-3);
  const auto json = nlohmann::json::parse(ekf_texts(given)[0].second);
  EXPECT_TRUE(json["figures"]["bias_correlation_time"]["value"].is_null());
}

// Both autopilots add (dt p)^2 to the variance every dt: after a second it has
// grown by that of the random walk, Q times 1 s.
TEST(ExportEkf, TheAutopilotsGrowTheVarianceOfTheRandomWalk) {
  const EkfExport given = given_export();
  const double walk = std::pow(given.figures.bias_walk * kRad, 2);
  const double noise = std::pow(given.figures.noise_density * kRad, 2);
  const auto grown = [&](const char* name, double dt) {
    double variance = 0.0;
    for (double t = 0.0; t < 1.0 - 0.5 * dt; t += dt)
      variance += std::pow(dt * parameter(given, name).value, 2);
    return variance / (dt * std::round(1.0 / dt));
  };
  EXPECT_NEAR(grown("EKF2_GYR_B_NOISE", 0.01) / walk, 1.0, 1e-9);
  EXPECT_NEAR(grown("EK3_GBIAS_P_NSE", 0.012) / walk, 1.0, 1e-9);
  EXPECT_NEAR(grown("EKF2_GYR_NOISE", 0.01) / noise, 1.0, 1e-9);
  EXPECT_NEAR(grown("EK3_GYRO_P_NSE", 0.012) / noise, 1.0, 1e-9);
}

TEST(ExportEkf, UnitsAreThoseOfEachFilter) {
  const EkfExport given = given_export();
  const EkfFigures& f = given.figures;
  EXPECT_NEAR(parameter(given, "EKF2_GBIAS_INIT").value,
              f.power_on_sigma * kRad, 1e-15);
  EXPECT_NEAR(parameter(given, "gyroscope_noise_density").value, 0.01 * kRad,
              1e-15);
  EXPECT_NEAR(parameter(given, "gyroscope_random_walk").value,
              f.bias_walk * kRad, 1e-15);
  EXPECT_EQ(parameter(given, "update_rate").value, 100.0);
  EXPECT_NEAR(parameter(given, "process_noise_covariance").value,
              std::pow(f.bias_walk * kRad, 2), 1e-18);
  EXPECT_NEAR(parameter(given, "angular_velocity_covariance").value,
              kRad * kRad * (1e-4 * 100.0 + std::pow(f.power_on_sigma, 2)),
              1e-18);
}

TEST(ExportEkf, AValueThatAFilterDoesNotTakeIsCutOffAndSaid) {
  EkfExport given = given_export();
  given.figures.bias_walk = 0.2;       // [deg/s/sqrt(s)]
  given.figures.noise_density = 1e-5;  // [deg/s/sqrt(Hz)]
  given.figures.power_on_sigma = 20.0;
  EXPECT_EQ(parameter(given, "EKF2_GYR_B_NOISE").written, 0.01);
  EXPECT_EQ(parameter(given, "EK3_GBIAS_P_NSE").written, 1e-3);
  EXPECT_EQ(parameter(given, "EKF2_GYR_NOISE").written, 1e-4);
  EXPECT_EQ(parameter(given, "EK3_GYRO_P_NSE").written, 1e-4);
  EXPECT_EQ(parameter(given, "EKF2_GBIAS_INIT").written, 0.2);
  const std::vector<std::string> warnings = ekf_warnings(given);
  ASSERT_EQ(warnings.size(), 5u);
  EXPECT_EQ(warnings[1],
            "EKF2_GYR_B_NOISE: 0.03491 rad/s^2 lies outside 0 to 0.01, which "
            "PX4 EKF2 documents; 0.01 is written");
  EXPECT_TRUE(
      holds(ekf_texts(given)[1].second, "1\t1\tEKF2_GYR_B_NOISE\t0.01\t9"));
  given.figures.bias_walk = 1e-3;
  given.figures.noise_density = 0.01;
  given.figures.power_on_sigma = 1.0;
  EXPECT_TRUE(ekf_warnings(given).empty());
}

// Element [vyaw, vyaw] of 15 x 15 is number 11 16 = 176, [vroll, vroll] 144.
TEST(ExportEkf, RobotLocalizationIsToldTheElementOfTheAxis) {
  EkfExport given = given_export();
  EXPECT_TRUE(holds(
      ekf_texts(given)[4].second,
      "process_noise_covariance: index 176 (from 0) of 225, [vyaw, vyaw]"));
  given.axis = 'x';
  const std::string text = ekf_texts(given)[4].second;
  EXPECT_TRUE(holds(text, "index 144 (from 0) of 225, [vroll, vroll]"));
  EXPECT_TRUE(holds(text, ", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]"));
}

Recording noisy_rest(double duration) {
  Recording rest = RecordedRun{.duration = duration, .step = 0.1}.recording();
  RandomStream random(1, 0, 0, kRestNoise);
  for (Column& column : rest.columns)
    if (column.name == "rate")
      for (double& value : column.values)
        value += 0.01 * std::sqrt(10.0) * random.normal();
  return rest;
}

TEST(RestNoise, FindsTheWhiteNoiseAndBoundsTheWalk) {
  const RestNoise noise = rest_noise(spline_compensator(), noisy_rest(7200.0));
  // White noise of 72,000 samples: N is known to about 0.3 %.
  EXPECT_NEAR(noise.coefficients.angle_random_walk->value, 0.01, 1.5e-4);
  EXPECT_NEAR(noise.sample_rate, 10.0, 1e-6);
  EXPECT_TRUE(noise.walk_is_bound);
  // sqrt(3) N / tau at the longest tau fitted, or a little more.
  const double longest = noise.coefficients.taus.back();
  EXPECT_GT(noise.walk, 0.3 * std::sqrt(3.0) * 0.01 / longest);
  EXPECT_LT(noise.walk, 3.0 * std::sqrt(3.0) * 0.01 / longest);
  EXPECT_EQ(noise.temperature_span, 0.0);
}

TEST(RestNoise, RefusesWhatIsNoRest) {
  const FittedCompensator c = spline_compensator();
  EXPECT_TRUE(holds(rejection([&] { rest_noise(c, noisy_rest(3.0)); }),
                    "samples show too little"));
  const Recording turning = RecordedRun{.true_rate = [](double t) {
                              return t > 300.0 ? 1.0 : 0.0;
                            }}.recording();
  EXPECT_EQ(rejection([&] { rest_noise(c, turning); }),
            "true_rate: from 0 to 1 deg/s; expected a recording at rest");
  EXPECT_EQ(rejection([&] { rest_noise(c, RecordedRun{}.recording()); }),
            "1200 samples show too little for noise coefficients; expected a "
            "longer recording at rest, with noise");
}

}  // namespace
}  // namespace beamgyro::internal::export_ekf_test
