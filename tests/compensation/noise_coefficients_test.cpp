// SPDX-License-Identifier: MIT
#include "compensation/noise_coefficients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dataset/random_stream.h"

namespace beamgyro {
namespace {

constexpr double kInterval = 0.1;          // [s]
constexpr std::size_t kSamples = 1 << 18;  // 7.3 h

std::vector<double> normals(RandomPurpose purpose, std::size_t count) {
  RandomStream stream(20240607, 0, 0, purpose);
  std::vector<double> values(count);
  stream.fill_normal(values);
  return values;
}

std::vector<double> white(double angle_random_walk) {
  auto rates = normals(RandomPurpose::kWhiteNoise, kSamples);
  for (double& rate : rates) {
    rate *= angle_random_walk / std::sqrt(kInterval);
  }
  return rates;
}

std::vector<double> random_walk(double k) {
  auto rates = normals(RandomPurpose::kRateRandomWalk, kSamples);
  double sum = 0.0;
  for (double& rate : rates) {
    sum += k * std::sqrt(kInterval) * rate;
    rate = sum;
  }
  return rates;
}

std::vector<AllanPoint> curve(const std::vector<double>& rates) {
  return oadev(rates, kInterval, octave_taus(rates.size(), kInterval));
}

/// Checks every point of eight clusters or more against the law in 3 sigma of
/// the record's length, sigma = `uncertainty` (point) of the deviation.
template <typename Law>
void expect_law(const std::vector<AllanPoint>& points, Law law,
                double (*uncertainty)(const AllanPoint&)) {
  int checked = 0;
  for (const AllanPoint& point : points) {
    if (point.clusters >= 8) {
      EXPECT_NEAR(point.deviation / law(point.tau), 1.0,
                  3.0 * uncertainty(point))
          << "tau = " << point.tau << " s, " << point.clusters << " clusters";
      ++checked;
    }
  }
  EXPECT_GE(checked, 15);
}

/// Of the plain deviation of white noise: neighbouring differences have the
/// correlation -1/2, so their mean square has the variance 3 sigma^4 / (M - 1).
double uncertainty_of_plain_white(const AllanPoint& point) {
  return 0.5 * std::sqrt(3.0 / (static_cast<double>(point.clusters) - 1.0));
}

std::vector<AllanPoint> exact_curve(double q, double n, double b, double k,
                                    double r) {
  std::vector<AllanPoint> points;
  for (std::size_t m = 1; m <= 1 << 16; m *= 2) {
    const double tau = kInterval * static_cast<double>(m);
    const double variance = 3.0 * q * q / (tau * tau) + n * n / tau +
                            2.0 * std::numbers::ln2 / std::numbers::pi * b * b +
                            k * k * tau / 3.0 + r * r * tau * tau / 2.0;
    points.push_back({tau, std::sqrt(variance), (std::size_t{1} << 28) / m});
  }
  return points;
}

TEST(Verification, V40WhiteNoiseHasItsAngleRandomWalkAtEveryTau) {
  const auto law = [](double tau) { return 0.01 / std::sqrt(tau); };
  const auto rates = white(0.01);
  expect_law(curve(rates), law, relative_uncertainty);
  expect_law(adev(rates, kInterval, octave_taus(rates.size(), kInterval)), law,
             uncertainty_of_plain_white);
}

TEST(Verification, V40RateRandomWalkGrowsAsTheRootOfTau) {
  const auto points = curve(random_walk(2e-4));
  // Averages of a walk in discrete steps: K^2 tau (2 m^2 + 1) / (6 m^2).
  expect_law(
      points,
      [](double tau) {
        const double m = tau / kInterval;
        return 2e-4 * std::sqrt(tau * (2.0 * m * m + 1.0) / (6.0 * m * m));
      },
      relative_uncertainty);
}

TEST(Verification, V40AngleQuantisationFallsAsOneOverTau) {
  // Angles rounded to a quantum q that the motion crosses at random: rounding
  // errors of q / sqrt 12 that are independent from sample to sample.
  constexpr double kQuantum = 0.01;  // [deg]
  RandomStream stream(7, 0, 0, RandomPurpose::kRateProfile);
  std::vector<double> rates;
  double before = 0.0;
  double angle = 0.0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    angle += kQuantum * (10.0 + 20.0 * stream.uniform());
    const double read = kQuantum * std::round(angle / kQuantum);
    rates.push_back((read - before) / kInterval);
    before = read;
  }
  RandomStream again(7, 0, 0, RandomPurpose::kRateProfile);
  for (double& rate : rates) {
    rate -= kQuantum * (10.0 + 20.0 * again.uniform()) / kInterval;
  }
  const double q = kQuantum / std::sqrt(12.0);
  expect_law(
      curve(rates), [q](double tau) { return std::sqrt(3.0) * q / tau; },
      relative_uncertainty);
}

TEST(NoiseCoefficients, AreThoseOfTheCurveInTheUnitsOfTheField) {
  const auto found =
      noise_coefficients(exact_curve(1e-3, 0.01, 0.01, 2e-4, 1e-6));
  EXPECT_NEAR(found.angle_quantisation.value(), 1e-3, 1e-9);
  EXPECT_NEAR(found.angle_random_walk.value(), 0.6, 1e-6);
  EXPECT_NEAR(found.rate_random_walk.value(), 43.2, 1e-4);
  EXPECT_NEAR(found.rate_ramp.value(), 12.96, 1e-4);
  EXPECT_GT(found.bias_instability.value(), 36.0);
  EXPECT_LT(found.bias_instability.value(), 37.5);
}

TEST(NoiseCoefficients, BiasInstabilityIsTheLowestDeviationOverItsConstant) {
  const auto points = exact_curve(0.0, 0.01, 0.0, 2e-4, 0.0);
  double lowest = 1.0;
  for (const AllanPoint& point : points) {
    lowest = std::min(lowest, point.deviation);
  }
  EXPECT_NEAR(noise_coefficients(points).bias_instability.value(),
              3600.0 * lowest / 0.6643, 0.01);
}

TEST(NoiseCoefficients, OfWhiteNoiseAreItsAngleRandomWalkAlone) {
  const auto found = noise_coefficients(curve(white(0.01)));
  EXPECT_NEAR(found.angle_random_walk.value(), 0.6, 0.006);
  EXPECT_FALSE(found.angle_quantisation);
  EXPECT_FALSE(found.rate_random_walk);
  EXPECT_FALSE(found.rate_ramp);
  EXPECT_FALSE(
      noise_coefficients(exact_curve(0, 0.01, 0, 0, 0)).bias_instability);
}

TEST(NoiseCoefficients, OfWhiteNoiseAndAWalkAreBoth) {
  auto rates = white(0.01);
  const auto walk = random_walk(1e-3);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    rates[k] += walk[k];
  }
  const auto found = noise_coefficients(curve(rates));
  EXPECT_NEAR(found.angle_random_walk.value(), 0.6, 0.012);
  EXPECT_NEAR(found.rate_random_walk.value(), 216.0, 22.0);
}

TEST(NoiseCoefficients, TextNamesEachUnitAndWhatIsMissing) {
  NoiseCoefficients coefficients;
  coefficients.angle_random_walk = 0.6;
  const std::string text = table(coefficients);
  EXPECT_NE(text.find("0.6 deg/sqrt(h)"), std::string::npos);
  EXPECT_EQ(text.find("deg/h"), std::string::npos);
}

TEST(NoiseCoefficients, RefuseACurveOfTooFewPoints) {
  const std::vector<double> rates(20, 1.0);
  EXPECT_THROW(noise_coefficients(curve(rates)), std::invalid_argument);
  EXPECT_THROW(noise_coefficients({{1.0, NAN, 100}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro
