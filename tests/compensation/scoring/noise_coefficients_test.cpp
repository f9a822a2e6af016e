// SPDX-License-Identifier: MIT
#include "compensation/scoring/noise_coefficients.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "random/random_stream.h"
#include "tests/compensation/scoring/noise_samples.h"

namespace beamgyro::internal::noise_coefficients_test {
namespace {

constexpr double kInterval = 0.01;         // [s]
constexpr std::size_t kSamples = 1 << 18;  // 44 min
constexpr double kPole = 0.02;             // [s], each of two equal ones
constexpr double kN = 0.01, kB = 0.005, kK = 1e-3, kQ = 1e-3;  // [deg], [s]

const NoiseSamples kRecord(kSamples, kInterval, 0);

std::vector<double> times(std::vector<double> rates, double factor) {
  for (double& rate : rates) rate *= factor;
  return rates;
}

std::vector<double> white() { return times(kRecord.white(), kN); }
std::vector<double> random_walk() { return times(kRecord.random_walk(), kK); }
std::vector<double> flicker() { return times(kRecord.flicker(), kB); }
std::vector<double> quantisation() { return times(kRecord.quantisation(), kQ); }

std::vector<double> sum(std::vector<double> rates,
                        const std::vector<double>& more) {
  for (std::size_t k = 0; k < rates.size(); ++k) rates[k] += more[k];
  return rates;
}

// Two equal poles: an output filter.
std::vector<double> band_limited(std::vector<double> rates) {
  const double keep = std::exp(-kInterval / kPole);
  double first = 0.0, second = 0.0;
  for (double& rate : rates) {
    first = keep * first + (1.0 - keep) * rate;
    second = keep * second + (1.0 - keep) * first;
    rate = second;
  }
  return rates;
}

EvenSeries series_of(const std::vector<double>& rates) {
  return internal::series_of(rates, kInterval);
}

// One sample in seven lacks.
EvenSeries with_gaps(std::vector<double> rates) {
  for (std::size_t k = 6; k < rates.size(); k += 7) rates[k] = NAN;
  EvenSeries series = series_of(rates);
  series.missing = rates.size() / 7;
  return series;
}

AllanCurve curve(const EvenSeries& series) {
  return allan_curve(series, octave_taus(series));
}

NoiseCoefficients found_in(const EvenSeries& series) {
  return noise_coefficients(curve(series).overlapping);
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
    const double tau = 0.1 * static_cast<double>(m);
    const double variance = 3.0 * q * q / (tau * tau) + n * n / tau +
                            2.0 * std::numbers::ln2 / std::numbers::pi * b * b +
                            k * k * tau / 3.0 + r * r * tau * tau / 2.0;
    points.push_back({tau, std::sqrt(variance), (std::size_t{1} << 28) / m});
  }
  return points;
}

/// Within three of its own standard errors, or `least` of the value.
void expect_estimate(const std::optional<CoefficientEstimate>& estimate,
                     double value, double least) {
  ASSERT_TRUE(estimate.has_value());
  EXPECT_NEAR(estimate->value, value,
              std::max(3.0 * estimate->uncertainty, least * value));
  EXPECT_LT(estimate->uncertainty, 0.3 * value);
}

TEST(Verification, V40WhiteNoiseHasItsAngleRandomWalkAtEveryTau) {
  const auto law = [](double tau) { return kN / std::sqrt(tau); };
  const AllanCurve found = curve(series_of(white()));
  expect_law(found.overlapping, law, relative_uncertainty);
  expect_law(found.plain, law, uncertainty_of_plain_white);
}

TEST(Verification, V40RateRandomWalkGrowsAsTheRootOfTau) {
  // Averages of a walk in discrete steps: K^2 tau (2 m^2 + 1) / (6 m^2).
  expect_law(
      curve(series_of(random_walk())).overlapping,
      [](double tau) {
        const double m = tau / kInterval;
        return kK * std::sqrt(tau * (2.0 * m * m + 1.0) / (6.0 * m * m));
      },
      relative_uncertainty);
}

TEST(Verification, V40AngleQuantisationFallsAsOneOverTau) {
  // Angles rounded to a quantum q that the motion crosses at random: rounding
  // errors of q / sqrt 12 that are independent from sample to sample.
  constexpr double kQuantum = 0.01;  // [deg]
  RandomStream stream(7, 0, 0, RandomPurpose{5});
  std::vector<double> rates;
  double before = 0.0;
  double angle = 0.0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    angle += kQuantum * (10.0 + 20.0 * stream.uniform());
    const double read = kQuantum * std::round(angle / kQuantum);
    rates.push_back((read - before) / kInterval);
    before = read;
  }
  RandomStream again(7, 0, 0, RandomPurpose{5});
  for (double& rate : rates) {
    rate -= kQuantum * (10.0 + 20.0 * again.uniform()) / kInterval;
  }
  const double q = kQuantum / std::sqrt(12.0);
  expect_law(
      curve(series_of(rates)).overlapping,
      [q](double tau) { return std::sqrt(3.0) * q / tau; },
      relative_uncertainty);
}

TEST(NoiseCoefficients, AreThoseOfTheCurve) {
  const auto found =
      noise_coefficients(exact_curve(1e-3, 0.01, 0.01, 2e-4, 1e-6));
  EXPECT_NEAR(found.angle_quantisation.value().value, 1e-3, 1e-9);
  EXPECT_NEAR(found.angle_random_walk.value().value, 0.01, 1e-8);
  EXPECT_NEAR(found.bias_instability.value().value, 0.01, 1e-8);
  EXPECT_NEAR(found.rate_random_walk.value().value, 2e-4, 1e-9);
  EXPECT_NEAR(found.rate_ramp.value().value, 1e-6, 1e-11);
  EXPECT_LT(found.misfit, 1e-6);
  EXPECT_FALSE(found.band_limit);
  EXPECT_EQ(found.taus.size(), 17U);
}

TEST(NoiseCoefficients, TellTheLowestDeviationWithoutCallingItFlicker) {
  const auto points = exact_curve(0.0, 0.01, 0.0, 2e-4, 0.0);
  const auto found = noise_coefficients(points);
  EXPECT_FALSE(found.bias_instability);
  EXPECT_FALSE(found.still_falling);
  for (const AllanPoint& point : points)
    EXPECT_LE(found.lowest.deviation, point.deviation);
  EXPECT_TRUE(
      noise_coefficients(exact_curve(0, 0.01, 0.001, 0, 0)).still_falling);
}

TEST(NoiseCoefficients, OfWhiteNoiseAreItsAngleRandomWalkAlone) {
  for (const bool gaps : {false, true}) {
    const auto found = found_in(gaps ? with_gaps(white()) : series_of(white()));
    expect_estimate(found.angle_random_walk, kN, 0.0);
    EXPECT_LT(found.angle_random_walk->uncertainty, 0.003 * kN);
    EXPECT_FALSE(found.angle_quantisation);
    EXPECT_FALSE(found.bias_instability);
    EXPECT_FALSE(found.rate_random_walk);
    EXPECT_FALSE(found.rate_ramp);
    EXPECT_FALSE(found.band_limit);
  }
}

// The shortest taus lie at 0.29 and 0.52 of N/sqrt(tau). What they follow is
// N^2/tau - 3 M/tau^2 but for terms of exp(-tau/pole), 2 % at four poles.
TEST(NoiseCoefficients, OfABandLimitedNoiseAreThoseOfItsFullBand) {
  for (const bool gaps : {false, true}) {
    const auto rates = band_limited(white());
    const auto found = found_in(gaps ? with_gaps(rates) : series_of(rates));
    expect_estimate(found.angle_random_walk, kN, 0.02);
    EXPECT_FALSE(found.angle_quantisation);
    EXPECT_FALSE(found.left_out.empty());
    EXPECT_LT(found.left_out.front().tau, found.taus.front());
    // Two poles T leave 3 M = 2.25 N^2 T, as one of 1.5 T. Sampling adds its
    // own: the filter of the test works in steps of half a pole.
    EXPECT_NEAR(found.band_limit.value(), 1.5 * kPole, 0.3 * kPole);
  }
}

TEST(NoiseCoefficients, OfFlickerIsItsBiasInstability) {
  for (const bool gaps : {false, true})
    for (const bool filter : {false, true}) {
      const auto rates = filter ? band_limited(flicker()) : flicker();
      expect_estimate(
          found_in(gaps ? with_gaps(rates) : series_of(rates)).bias_instability,
          kB, 0.02);
    }
}

TEST(NoiseCoefficients, FindFlickerWhereACurveFlattens) {
  for (const bool gaps : {false, true})
    for (const bool filter : {false, true}) {
      auto rates = sum(white(), flicker());
      if (filter) rates = band_limited(rates);
      const auto found = found_in(gaps ? with_gaps(rates) : series_of(rates));
      expect_estimate(found.angle_random_walk, kN, 0.025);
      expect_estimate(found.bias_instability, kB, 0.1);
    }
}

// A filter takes from a walk's variance a share that falls as pole/tau only,
// and no term of the law describes it. Gaps are bridged as those of white
// noise.
TEST(NoiseCoefficients, OfAWalkIsItsRateRandomWalk) {
  for (const bool gaps : {false, true})
    for (const bool filter : {false, true}) {
      const auto rates = filter ? band_limited(random_walk()) : random_walk();
      const auto found = found_in(gaps ? with_gaps(rates) : series_of(rates));
      SCOPED_TRACE(testing::Message()
                   << "gaps " << gaps << ", filter " << filter);
      expect_estimate(found.rate_random_walk, kK,
                      filter ? 0.05
                      : gaps ? 0.03
                             : 0.01);
      EXPECT_FALSE(found.band_limit);
    }
}

TEST(NoiseCoefficients, OfWhiteNoiseAndAWalkAreBoth) {
  for (const bool filter : {false, true}) {
    auto rates = sum(white(), random_walk());
    if (filter) rates = band_limited(rates);
    const auto found = found_in(series_of(rates));
    expect_estimate(found.angle_random_walk, kN, 0.025);
    expect_estimate(found.rate_random_walk, kK, 0.1);
  }
}

// A filter takes its share of the angle's errors, in steps of kInterval
// (1 - p)^2 (1 + p^2) / (1 + p)^3 / (1 - p) of the square with p = exp(-1/2).
TEST(NoiseCoefficients, OfQuantisationIsTheErrorOfTheAngle) {
  expect_estimate(found_in(series_of(quantisation())).angle_quantisation, kQ,
                  0.01);
  const double p = std::exp(-kInterval / kPole);
  const double share =
      std::pow(1.0 - p, 4) * (1.0 + p * p) / std::pow(1.0 - p * p, 3);
  expect_estimate(
      found_in(series_of(band_limited(quantisation()))).angle_quantisation,
      std::sqrt(share) * kQ, 0.02);
  // The angle turned in a missing sample is lost, which adds white noise.
  expect_estimate(found_in(with_gaps(quantisation())).angle_quantisation, kQ,
                  0.1);
}

TEST(NoiseCoefficients, ATauThatFitsNoTermDoesNotDecide) {
  std::vector<AllanPoint> points = exact_curve(0.0, 0.01, 0.0, 2e-4, 0.0);
  for (std::size_t k = 0; k < points.size(); ++k)
    points[k].deviation *= k % 2 == 0 ? 1.02 : 0.98;
  const auto found = noise_coefficients(points);
  EXPECT_NEAR(found.misfit, 0.02, 0.005);
  expect_estimate(found.angle_random_walk, 0.01, 0.02);
  EXPECT_GT(found.angle_random_walk->uncertainty, 0.002 * 0.01);
}

using Find = std::optional<CoefficientEstimate> NoiseCoefficients::*;

/// Of a hundred records of noise at `truth` at least ninety have it within
/// their 95 % intervals, which are no more than twice as wide as the scatter
/// asks for.
template <typename Make>
void expect_coverage(const char* what, Find coefficient, double truth,
                     Make rates) {
  SCOPED_TRACE(what);
  constexpr std::uint32_t kRecords = 100;
  int covered = 0, found = 0;
  double squares = 0.0, uncertainties = 0.0;
  for (std::uint32_t run = 0; run < kRecords; ++run) {
    const NoiseSamples samples(2048, 0.1, run);
    const auto of_run = found_in(internal::series_of(rates(samples), 0.1));
    const auto& estimate = of_run.*coefficient;
    if (!estimate) continue;
    ++found;
    covered +=
        estimate->interval.low <= truth && truth <= estimate->interval.high;
    squares += std::pow(estimate->value - truth, 2);
    uncertainties += std::pow(estimate->uncertainty, 2);
  }
  EXPECT_GE(found, 98);
  EXPECT_GE(covered, 0.9 * found);
  EXPECT_LE(uncertainties, 4.0 * squares);
}

TEST(ManyDrawsOfCoefficients, HaveIntervalsThatHoldTheTruth) {
  expect_coverage("quantisation", &NoiseCoefficients::angle_quantisation, 0.5,
                  [](const auto& s) { return times(s.quantisation(), 0.5); });
  expect_coverage("white", &NoiseCoefficients::angle_random_walk, 0.5,
                  [](const auto& s) { return times(s.white(), 0.5); });
  expect_coverage("flicker", &NoiseCoefficients::bias_instability, 0.5,
                  [](const auto& s) { return times(s.flicker(), 0.5); });
  expect_coverage("random walk", &NoiseCoefficients::rate_random_walk, 0.5,
                  [](const auto& s) { return times(s.random_walk(), 0.5); });
  expect_coverage(
      "ramp", &NoiseCoefficients::rate_ramp, 0.2,
      [](const auto& s) { return sum(s.white(), times(s.ramp(), 0.2)); });
  expect_coverage("white noise on flicker",
                  &NoiseCoefficients::bias_instability, 1.0,
                  [](const auto& s) { return sum(s.white(), s.flicker()); });
}

TEST(NoiseCoefficients, AreReportedInSecondsAndInHours) {
  NoiseCoefficients coefficients;
  coefficients.angle_random_walk = {{0.01, 0.0001, {0.0098, 0.0102}}};
  coefficients.bias_instability = {{0.002, 0.0001}};
  coefficients.rate_ramp = {{1e-6, 1e-8}};
  const auto rates = to_json(coefficients, "deg/s");
  EXPECT_DOUBLE_EQ(rates["N"]["per_second"]["value"], 0.01);
  EXPECT_EQ(rates["N"]["per_second"]["unit"], "deg/sqrt(s)");
  EXPECT_DOUBLE_EQ(rates["N"]["per_hour"]["value"], 0.6);
  EXPECT_EQ(rates["N"]["per_hour"]["unit"], "deg/sqrt(h)");
  EXPECT_DOUBLE_EQ(rates["N"]["relative_uncertainty"], 0.01);
  EXPECT_DOUBLE_EQ(rates["B"]["per_hour"]["value"], 7.2);
  EXPECT_DOUBLE_EQ(rates["R"]["per_hour"]["value"], 12.96);
  EXPECT_EQ(rates["R"]["per_hour"]["unit"], "deg/h/h");
  EXPECT_DOUBLE_EQ(rates["N"]["per_second"]["interval"][0], 0.0098);
  EXPECT_DOUBLE_EQ(rates["N"]["per_hour"]["interval"][1], 0.612);
  EXPECT_TRUE(rates["K"].is_null());
  const auto volts = to_json(coefficients, "V");
  EXPECT_EQ(volts["N"]["per_hour"]["unit"], "V sqrt(h)");
  EXPECT_DOUBLE_EQ(volts["N"]["per_hour"]["value"], 0.01 / 60.0);
  EXPECT_EQ(volts["B"]["per_hour"]["value"], volts["B"]["per_second"]["value"]);
  EXPECT_DOUBLE_EQ(volts["R"]["per_hour"]["value"], 0.0036);
}

TEST(NoiseCoefficients, RefuseACurveOfTooFewPoints) {
  const std::vector<double> rates(20, 1.0);
  EXPECT_THROW(found_in(series_of(rates)), std::invalid_argument);
  EXPECT_THROW(noise_coefficients({{1.0, NAN, 100}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::noise_coefficients_test
