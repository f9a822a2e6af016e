// SPDX-License-Identifier: MIT
#include "sim/signal/output_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "random/random_stream.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::output_filter_test {
namespace {

constexpr double kPi = std::numbers::pi;

// Answers of the two poles at rest to the unit step and the unit ramp at t = 0.
double step_answer(double w, double t) {
  return t <= 0.0 ? 0.0 : 1.0 - (1.0 + w * t) * std::exp(-w * t);
}
double ramp_answer(double w, double t) {
  return t <= 0.0 ? 0.0 : t - 2.0 / w + (t + 2.0 / w) * std::exp(-w * t);
}

TEST(OutputFilter, AnswersAStepBetweenTwoSamplesByTheClosedForm) {
  for (double rate : {0.5, 10.0, 200.0, 5000.0}) {
    const double w = 2.0 * kPi * 60.0, jump = 10.3 / rate;
    const PiecewiseLinear input({0.0, jump, jump}, {1.0, 1.0, 4.0});
    const auto output = OutputFilter(w).response(input, rate, 200);
    for (std::size_t k = 0; k < output.size(); ++k) {
      const double t = static_cast<double>(k) / rate;
      ASSERT_NEAR(output[k], 1.0 + 3.0 * step_answer(w, t - jump), 1e-12) << t;
    }
  }
}

TEST(OutputFilter, FollowsARampTwoTimeConstantsLate) {
  const double w = 2.0 * kPi * 5.0, rate = 40.0, start = 0.333, slope = 20.0;
  const PiecewiseLinear input({start, start + 100.0}, {0.0, 100.0 * slope});
  const auto output = OutputFilter(w).response(input, rate, 400);
  for (std::size_t k = 0; k < output.size(); ++k) {
    const double t = static_cast<double>(k) / rate;
    ASSERT_NEAR(output[k], slope * ramp_answer(w, t - start), 1e-12 * 200) << t;
  }
  EXPECT_NEAR(output.back(), slope * (399.0 / rate - start - 2.0 / w), 1e-9);
}

// A linear system: the answer to any profile is the sum of its corners' and
// jumps' own answers.
TEST(OutputFilter, SuperposesTheAnswersOfManyRandomPoints) {
  const double w = 2.0 * kPi * 3.0, rate = 20.0;
  RandomStream random(5, 0, 0, kRateProfileStream);
  std::vector<double> time = {0.0}, value = {0.7};
  while (time.size() < 2000) {
    const bool jump = random.uniform() < 0.2 && time.size() % 2 == 1;
    time.push_back(time.back() + (jump ? 0.0 : 0.02 * random.uniform()));
    value.push_back(random.normal());
  }
  const auto output =
      OutputFilter(w).response(PiecewiseLinear(time, value), rate, 500);
  std::size_t compared = 0;
  for (std::size_t k = 0; k < output.size(); k += 7, ++compared) {
    const double t = static_cast<double>(k) / rate;
    double sum = value[0];
    for (std::size_t i = 1; i < time.size(); ++i) {
      const double rise = value[i] - value[i - 1], h = time[i] - time[i - 1];
      sum += h == 0.0 ? rise * step_answer(w, t - time[i])
                      : rise / h *
                            (ramp_answer(w, t - time[i - 1]) -
                             ramp_answer(w, t - time[i]));
    }
    ASSERT_NEAR(output[k], sum, 1e-10) << t;  // the sum has slopes of 1e4
  }
  EXPECT_EQ(compared, 72u);
}

TEST(OutputFilter, TakesARampOfOnePicosecondForAJump) {
  const double w = 2.0 * kPi * 60.0, rate = 200.0;
  const auto ramp = OutputFilter(w).response(
      PiecewiseLinear({1.0, 1.0 + 1e-12}, {0.0, 100.0}), rate, 300);
  const auto jump = OutputFilter(w).response(
      PiecewiseLinear({1.0, 1.0}, {0.0, 100.0}), rate, 300);
  for (std::size_t k = 0; k < ramp.size(); ++k)
    ASSERT_NEAR(ramp[k], jump[k], 1e-7) << k;  // w * 1e-12 s * 100
}

TEST(OutputFilter, StartsSettledOnTheInputAtZero) {
  const OutputFilter filter(100.0);
  const std::vector<PiecewiseLinear> inputs = {
      PiecewiseLinear::constant(3.0), PiecewiseLinear({5.0, 6.0}, {3.0, 4.0}),
      PiecewiseLinear({0.0, 0.0}, {-1.0, 3.0}),
      PiecewiseLinear({-2.0, -1.0}, {7.0, 3.0})};
  for (const auto& input : inputs)
    for (double y : filter.response(input, 10.0, 50)) ASSERT_EQ(y, 3.0);
}

TEST(OutputFilter, ForgetsAPulseAltogether) {
  const PiecewiseLinear pulse({0.0, 0.5, 0.5}, {1.0, 1.0, 0.0});
  const auto output = OutputFilter(1.0).response(pulse, 50.0, 50000);
  EXPECT_GT(output[5000], 0.0);
  EXPECT_EQ(output.back(), 0.0);  // no subnormal number for ever
}

TEST(OutputFilter, AnswersASineByItsGainFromTheFirstSample) {
  const double w = 2.0 * kPi * 60.0, rate = 200.0;
  for (double frequency : {0.01, 1.0, 38.6, 60.0, 90.0}) {
    const SineSignal input{2.0, 30.0, frequency, 0.4};
    const auto output = OutputFilter(w).response(input, rate, 1000);
    const double r = frequency / 60.0;
    for (std::size_t k = 0; k < output.size(); ++k) {
      const double angle =
          2.0 * kPi * frequency * static_cast<double>(k) / rate;
      ASSERT_NEAR(output[k],
                  2.0 + 30.0 / (1.0 + r * r) *
                            std::sin(angle + 0.4 - 2.0 * std::atan(r)),
                  30.0 * 1e-12)
          << frequency << " Hz, " << k;
    }
  }
}

TEST(OutputFilter, TreatsASineAndItsChordsAlike) {
  const double w = 2.0 * kPi * 20.0, rate = 100.0, frequency = 3.0;
  std::vector<double> time, value;
  for (int i = 0; i <= 20000; ++i) {
    time.push_back(1e-4 * i);
    value.push_back(std::sin(2.0 * kPi * frequency * time.back()));
  }
  const OutputFilter filter(w);
  const auto chords = filter.response(PiecewiseLinear(time, value), rate, 200);
  const auto sine =
      filter.response(SineSignal{0.0, 1.0, frequency, 0.0}, rate, 200);
  // Chords are (omega h)^2 / 8 off; the start has died out after 0.4 s.
  for (std::size_t k = 40; k < 200; ++k)
    ASSERT_NEAR(chords[k], sine[k], 1e-6) << k;
}

TEST(OutputFilter, PairOfPolesIsThreeDecibelDownAtTheRootOfRootTwoLessOne) {
  const OutputFilter filter(100.0);
  const double edge = 100.0 * std::sqrt(std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(std::abs(filter.gain(edge)), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(std::abs(filter.gain(100.0)), 0.5, 1e-15);
  EXPECT_NEAR(std::arg(filter.gain(100.0)), -0.5 * kPi, 1e-15);
}

TEST(OutputFilter, RejectsBadCornersAndOutputRates) {
  EXPECT_EQ(rejection([] { OutputFilter(0.0); }),
            "output filter corner is 0 rad/s, must be above 0");
  EXPECT_THROW(OutputFilter(NAN), std::invalid_argument);
  const OutputFilter filter(1.0);
  EXPECT_THROW(filter.response(PiecewiseLinear::constant(0.0), -1.0, 1),
               std::invalid_argument);
  EXPECT_THROW(filter.response(SineSignal{}, INFINITY, 1),
               std::invalid_argument);
}

TEST(OutputFilter, AnswersInPiecesAsInOne) {
  const std::vector<Signal> inputs = {
      PiecewiseLinear({0.0, 0.5, 0.5, 2.7}, {1.0, 2.0, -1.0, 0.5}),
      PiecewiseLinear::constant(3.0),
      SineSignal{.offset = 0.5, .amplitude = 2.0, .frequency = 1.3}};
  for (const Signal& input : inputs) {
    const OutputFilter filter(2.0 * kPi * 3.0);
    const std::vector<double> whole = filter.response(input, 20.0, 100);
    std::vector<double> pieces(100);
    const SampleStream stream = filter.responses(input, 20.0);
    for (std::size_t k = 0, n = 1; k < 100; k += n, n = (n + 6) % 17)
      stream(std::span(pieces).subspan(k, std::min(n, 100 - k)));
    EXPECT_EQ(pieces, whole);
  }
}

}  // namespace
}  // namespace beamgyro::internal::output_filter_test
