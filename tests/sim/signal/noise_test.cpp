// SPDX-License-Identifier: MIT
#include "sim/signal/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

#include "random/random_stream.h"
#include "sim/signal/readout.h"
#include "tests/config/rejection.h"
#include "tests/sim/signal/allan_deviation.h"

namespace beamgyro::internal::noise_test {
namespace {

constexpr double kN = 2e-4, kB = 1e-4, kK = 3e-6, kOn = 5e-4;
constexpr NoiseParameters kAll = {.angle_random_walk = kN,
                                  .bias_instability = kB,
                                  .rate_random_walk = kK,
                                  .turn_on = kOn};

std::vector<double> noise(const NoiseParameters& parameters, double output_rate,
                          std::size_t count, std::uint32_t run = 0) {
  std::vector<double> rate(count, 0.0);
  RateNoise(parameters, output_rate, 11, 0, run).add_next(rate);
  return rate;
}

TEST(Verification, V40WhiteNoiseHasTheAngleRandomWalk) {
  constexpr double kRate = 10.0;
  const auto rate = noise({.angle_random_walk = kN}, kRate, 1000000);
  for (std::size_t m : {1u, 10u, 100u, 1000u}) {
    const AllanDeviation adev = allan_deviation(rate, m);
    const double tau = static_cast<double>(m) / kRate;
    EXPECT_NEAR(adev.value, kN / std::sqrt(tau), adev.three_sigma) << tau;
  }
}

TEST(Verification, V40RateRandomWalkGrowsWithTheRootOfTime) {
  constexpr double kRate = 10.0;
  const auto rate = noise({.rate_random_walk = kK}, kRate, 1000000);
  for (std::size_t m : {10u, 100u, 1000u}) {
    const AllanDeviation adev = allan_deviation(rate, m);
    const double tau = static_cast<double>(m) / kRate;
    EXPECT_NEAR(adev.value, kK * std::sqrt(tau / 3.0), adev.three_sigma) << tau;
  }
}

TEST(Verification, V40AngleQuantumFallsWithTime) {
  constexpr double kLsb = 1e-3, kRate = 10.0;  // [rad] [Hz]
  constexpr std::size_t kCount = 300000;
  const double Q = kLsb / std::sqrt(12.0);
  // Steps of many quanta, so that the rounding errors are independent.
  RandomStream stream(2, 0, 0, kRateProfileStream);
  std::vector<double> rate(kCount);
  double angle = 0.0, error = 0.0;
  for (double& r : rate) {
    angle += 100.0 * kLsb * stream.normal();
    const double next_error = quantise(angle, kLsb) - angle;
    r = (next_error - error) * kRate;
    error = next_error;
  }
  for (std::size_t m : {1u, 10u, 100u}) {
    const AllanDeviation adev = allan_deviation(rate, m);
    const double tau = static_cast<double>(m) / kRate;
    EXPECT_NEAR(adev.value, std::sqrt(3.0) * Q / tau, adev.three_sigma) << tau;
  }
}

TEST(RateNoise, WhiteVarianceIsTheSquareOfNTimesTheOutputRate) {
  constexpr std::size_t kCount = 400000;
  for (double output_rate : {0.1, 10.0, 200.0, 50000.0}) {
    double variance = 0.0;
    for (double r : noise({.angle_random_walk = kN}, output_rate, kCount))
      variance += r * r / kCount;
    EXPECT_NEAR(variance / (kN * kN * output_rate), 1.0,
                3.0 * std::sqrt(2.0 / kCount))
        << output_rate;
  }
}

TEST(RateNoise, RateRandomWalkStartsAtZeroWithStepsOfItsVariance) {
  constexpr double kRate = 4.0;
  const auto rate = noise({.rate_random_walk = kK}, kRate, 200000);
  EXPECT_EQ(rate[0], 0.0);
  const double steps = static_cast<double>(rate.size() - 1);
  double variance = 0.0;
  for (std::size_t i = 1; i < rate.size(); ++i)
    variance += (rate[i] - rate[i - 1]) * (rate[i] - rate[i - 1]) / steps;
  EXPECT_NEAR(variance / (kK * kK / kRate), 1.0, 3.0 * std::sqrt(2.0 / steps));
}

// The walk of a run at 10 Hz that begins at an age [s].
std::vector<double> aged_walk(double age, std::size_t count,
                              std::uint32_t run) {
  std::vector<double> rate(count, 0.0);
  RateNoise({.rate_random_walk = kK}, 10.0, 11, 5, run, age).add_next(rate);
  return rate;
}

TEST(RateNoise, ARunGoesOnWithTheWalkWhereAnEarlierOneEnded) {
  for (const double age : {0.0, 1234.0, 3.6e6, 3.15576e7, 3600.123}) {
    const auto whole = aged_walk(age, 30001, 3);
    const auto first = aged_walk(age, 9001, 4);
    const auto second = aged_walk(age + 900, 21001, 5);
    EXPECT_NE(whole[9000], whole[0]);
    // Ages near a year are rounded to 4e-9 s, of a slope of some K/sqrt(s).
    for (std::size_t i = 0; i < first.size(); ++i)
      ASSERT_NEAR(first[i], whole[i], 1e-7 * kK) << age << ' ' << i;
    for (std::size_t i = 0; i < second.size(); ++i)
      ASSERT_NEAR(second[i], whole[9000 + i], 1e-7 * kK) << age << ' ' << i;
    EXPECT_EQ(first.back(), second.front()) << age;
  }
  EXPECT_EQ(aged_walk(0, 1, 3).front(), 0.0);
}

// Of a first-order Gauss-Markov process that is 0 at the trim.
TEST(WalkSinceTrim, HasTheLawOfGaussAndMarkovBetweenAnyTwoAges) {
  constexpr std::uint32_t kDevices = 20000;
  constexpr double kCorrelation = 3.6e5;  // [s], 100 h
  // Steps of 40 s, 1 h, 1000 h, a year, and a century.
  constexpr double kAges[] = {0.0, 40.0, 3640.0, 3.60364e6, 3.515e7, 3.2e9};
  const auto variance = [](double age) {
    return 0.5 * kCorrelation * -std::expm1(-2.0 * age / kCorrelation);
  };
  for (std::size_t i = 1; i < std::size(kAges); ++i) {
    const double kept = std::exp((kAges[i - 1] - kAges[i]) / kCorrelation);
    double all = 0.0, fresh = 0.0, overlap = 0.0;
    for (std::uint32_t device = 0; device < kDevices; ++device) {
      WalkSinceTrim walk(7, device, kCorrelation);
      const double before = walk.at(kAges[i - 1]), after = walk.at(kAges[i]);
      const double step = after - kept * before;
      all += after * after / kDevices;
      fresh += step * step / kDevices;
      overlap += step * before / kDevices;
    }
    const double step = variance(kAges[i] - kAges[i - 1]);
    const double three_sigma = 3.0 * std::sqrt(2.0 / kDevices);
    EXPECT_NEAR(all / variance(kAges[i]), 1.0, three_sigma) << i;
    EXPECT_NEAR(fresh / step, 1.0, three_sigma) << i;
    EXPECT_NEAR(overlap, 0.0,
                3.0 * std::sqrt(step * variance(kAges[i - 1]) / kDevices));
  }
}

TEST(WalkSinceTrim, IsAWienerPathOverTimesBelowItsCorrelation) {
  // The Allan slope of a day within a run is that of K, whatever came before.
  constexpr std::size_t kCount = 86400;
  for (const double age : {0.0, 3.15576e7}) {
    WalkSinceTrim walk(7, 4, 3.6e6);
    std::vector<double> rate(kCount);
    for (std::size_t i = 0; i < kCount; ++i)
      rate[i] = walk.at(age + static_cast<double>(i));
    for (const std::size_t m : {10u, 100u, 1000u}) {
      const AllanDeviation adev = allan_deviation(rate, m);
      EXPECT_NEAR(adev.value, std::sqrt(static_cast<double>(m) / 3.0),
                  adev.three_sigma)
          << age << ' ' << m;
    }
  }
}

TEST(WalkSinceTrim, HasIndependentStepsOfASecond) {
  constexpr std::size_t kSteps = 100000;
  WalkSinceTrim walk(7, 3, 3.6e5);
  double variance = 0.0, product = 0.0, last = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double age = 1e6 + static_cast<double>(i);
    const double step = walk.at(age + 1) - walk.at(age);
    variance += step * step / kSteps;
    product += step * last / kSteps;
    last = step;
  }
  EXPECT_NEAR(variance, 1.0, 3.0 * std::sqrt(2.0 / kSteps));
  EXPECT_NEAR(product, 0.0, 3.0 / std::sqrt(double{kSteps}));
}

TEST(WalkSinceTrim, DoesNotDependOnTheOrderOfAges) {
  WalkSinceTrim walk(7, 3, 3.6e5);
  for (const double age : {5.5, 3.6e6, 0.0, 4.2e9, 4294967296.0, 17.0, 5.5})
    EXPECT_EQ(walk.at(age), WalkSinceTrim(7, 3, 3.6e5).at(age)) << age;
}

TEST(WalkSinceTrim, RejectsAnAgeThatIsNone) {
  WalkSinceTrim walk(7, 3, 3.6e5);
  EXPECT_EQ(walk.at(0.0), 0.0);
  EXPECT_THROW(walk.at(-1.0), std::invalid_argument);
  EXPECT_THROW(walk.at(NAN), std::invalid_argument);
  EXPECT_THROW(walk.at(1e10), std::invalid_argument);
}

TEST(RateNoise, PartsAreIndependentAndAddUp) {
  const auto all = noise(kAll, 10.0, 1000);
  const auto white = noise({.angle_random_walk = kN}, 10.0, 1000);
  const auto flicker = noise({.bias_instability = kB}, 10.0, 1000);
  const auto walk = noise({.rate_random_walk = kK}, 10.0, 1000);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(all[i], white[i] + flicker[i] + walk[i], 1e-18);
}

TEST(RateNoise, WithoutParametersChangesNothing) {
  std::vector<double> rate(100, 0.25);
  RateNoise({}, 10.0, 1, 0, 0).add_next(rate);
  EXPECT_EQ(rate, std::vector<double>(100, 0.25));
}

TEST(RateNoise, DoesNotDependOnHowTheRunIsCut) {
  const auto whole = noise(kAll, 10.0, 5000);
  std::vector<double> cut(5000, 0.0);
  RateNoise noise(kAll, 10.0, 11, 0, 0);
  for (std::size_t i = 0; i < cut.size();) {
    const std::size_t piece = std::min<std::size_t>(i / 3 + 1, 5000 - i);
    noise.add_next(std::span(cut).subspan(i, piece));
    i += piece;
  }
  EXPECT_EQ(whole, cut);
}

TEST(Verification, V47NoiseHasTheSameBitsFromTwoThreads) {
  constexpr std::uint32_t kRuns = 8;
  std::vector<std::vector<double>> one(kRuns), two(kRuns);
  for (std::uint32_t run = 0; run < kRuns; ++run)
    one[run] = noise(kAll, 10.0, 20000, run);
  const auto half = [&two](std::uint32_t first) {
    for (std::uint32_t run = first; run < kRuns; run += 2)
      two[run] = noise(kAll, 10.0, 20000, run);
  };
  std::thread other(half, 1);
  half(0);
  other.join();
  EXPECT_EQ(one, two);
  EXPECT_NE(one[0], one[1]);
}

TEST(TurnOnOffsets, OneCycleKeepsItsValueWhateverFollows) {
  const auto few = turn_on_offsets(kAll, 2, 1, 0, 0);
  const auto many = turn_on_offsets(kAll, 500, 1, 0, 0);
  ASSERT_EQ(few.size(), 2u);
  EXPECT_EQ(few[0], many[0]);
  EXPECT_EQ(few[1], many[1]);
  EXPECT_NE(few[0], few[1]);
}

TEST(TurnOnOffsets, HaveTheirSigma) {
  constexpr std::size_t kCycles = 20000;
  double variance = 0.0;
  for (double offset : turn_on_offsets(kAll, kCycles, 1, 0, 0))
    variance += offset * offset / kCycles;
  EXPECT_NEAR(variance / (kOn * kOn), 1.0, 3.0 * std::sqrt(2.0 / kCycles));
}

TEST(TurnOnTransients, RecoverWhileThePowerIsOff) {
  const NoiseParameters transient = {.turn_on_transient = kOn,
                                     .turn_on_recovery = 3600.0};
  const std::vector<double> off = {INFINITY, 0.0, 3600.0, 1e9};
  const std::vector<double> long_off(4, INFINITY);
  const auto some = turn_on_transients(transient, off, 1, 2, 3);
  const auto full = turn_on_transients(transient, long_off, 1, 2, 3);
  EXPECT_EQ(some[0], full[0]);
  EXPECT_EQ(some[1], 0.0);
  EXPECT_NEAR(some[2] / full[2], 1.0 - std::exp(-1.0), 1e-15);
  EXPECT_EQ(some[3], full[3]);
}

TEST(TurnOnTransients, HaveTheirSigma) {
  const std::vector<double> off(20000, INFINITY);
  double variance = 0.0;
  for (double a : turn_on_transients({.turn_on_transient = kOn}, off, 1, 0, 0))
    variance += a * a / 20000;
  EXPECT_NEAR(variance / (kOn * kOn), 1.0, 3.0 * std::sqrt(2.0 / 20000));
}

std::string rejection_of(const NoiseParameters& parameters,
                         double output_rate) {
  return rejection([&] { RateNoise(parameters, output_rate, 0, 0, 0); });
}

TEST(RateNoise, RejectsBadParameters) {
  EXPECT_EQ(rejection_of({.angle_random_walk = -1.0}, 10.0),
            "angle random walk is -1 rad/sqrt(s), must be 0 or more");
  EXPECT_EQ(rejection_of({.bias_instability = INFINITY}, 10.0),
            "bias instability is inf rad/s, must be 0 or more");
  EXPECT_EQ(rejection_of({.walk_correlation = 0.0}, 10.0),
            "correlation time of the walk is 0 s, must be above 0");
  EXPECT_EQ(rejection_of({.rate_random_walk = NAN}, 10.0),
            "rate random walk is nan rad/s/sqrt(s), must be 0 or more");
  EXPECT_EQ(rejection_of({.turn_on = -2.0}, 10.0),
            "turn-on offset is -2 rad/s, must be 0 or more");
  EXPECT_EQ(rejection_of({}, -10.0), "output rate is -10 Hz, must be above 0");
  EXPECT_EQ(rejection_of({}, NAN), "output rate is nan Hz, must be above 0");
  EXPECT_THROW(turn_on_offsets({.turn_on = NAN}, 1, 0, 0, 0),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::noise_test
