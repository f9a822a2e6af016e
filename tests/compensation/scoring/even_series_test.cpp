// SPDX-License-Identifier: MIT
#include "compensation/scoring/even_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "compensation/scoring/allan_deviation.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::even_series_test {
namespace {

// A sample a second for 100 s, without power from 30 to 40 s.
Recording two_cycles() {
  return RecordedRun{.duration = 100.0,
                     .step = 1.0,
                     .powered = [](double t) { return t < 30.0 || t >= 40.0; }}
      .recording();
}

void leave_out_every(std::size_t period, Recording& recording) {
  Recording kept = recording;
  kept.time.clear();
  kept.status.clear();
  for (Column& column : kept.columns) column.values.clear();
  for (std::size_t k = 0; k < recording.time.size(); ++k) {
    if (k % period == period - 1) continue;
    kept.time.push_back(recording.time[k]);
    kept.status.push_back(recording.status[k]);
    for (std::size_t c = 0; c < kept.columns.size(); ++c)
      kept.columns[c].values.push_back(recording.columns[c].values[k]);
  }
  recording = kept;
}

TEST(EvenSeries, BeginsAnewWherePowerComesOn) {
  const EvenSeries series = even_series(two_cycles(), "rate");
  ASSERT_EQ(series.stretches.size(), 2U);
  EXPECT_EQ(series.stretches[0].size(), 30U);
  EXPECT_EQ(series.stretches[1].size(), 60U);
  EXPECT_EQ(series.samples, 90U);
  EXPECT_EQ(series.missing, 0U);
  EXPECT_EQ(series.left_out, 10U);
  EXPECT_DOUBLE_EQ(series.interval, 1.0);
  EXPECT_EQ(series.first, 0.0);
  EXPECT_EQ(series.last, 99.0);
}

TEST(EvenSeries, KeepsThePlacesOfMissingSamples) {
  Recording run = two_cycles();
  run.columns[1].values[60] = NAN;
  leave_out_every(7, run);
  const EvenSeries series = even_series(run, "rate");
  ASSERT_EQ(series.stretches.size(), 2U);
  EXPECT_DOUBLE_EQ(series.interval, 1.0);
  // Samples 6, 13, 20, 27 of the first 30; 41, 48, ... 97 and 60 of the rest.
  EXPECT_EQ(series.stretches[0].size(), 30U);
  EXPECT_EQ(series.stretches[1].size(), 60U);
  EXPECT_EQ(series.missing, 4U + 9U + 1U);
  EXPECT_EQ(series.samples, 26U + 50U);
  EXPECT_TRUE(std::isnan(series.stretches[0][6]));
  EXPECT_TRUE(std::isnan(series.stretches[1][20]));
  EXPECT_FALSE(std::isnan(series.stretches[1][0]));
}

TEST(EvenSeries, BeginsAnewAfterAGapThatNothingCanBridge) {
  Recording run = two_cycles();
  for (std::size_t k = 50; k < 100; ++k) run.time[k] += 1e9;
  const EvenSeries series = even_series(run, "rate");
  ASSERT_EQ(series.stretches.size(), 3U);
  EXPECT_EQ(series.stretches[1].size(), 10U);
  EXPECT_EQ(series.stretches[2].size(), 50U);
  EXPECT_DOUBLE_EQ(series.interval, 1.0);
  // Bursts of ten with breaks of twice their length are one stretch.
  for (std::size_t k = 50; k < 100; ++k) run.time[k] -= 1e9 - 20.0;
  EXPECT_EQ(even_series(run, "rate").stretches.size(), 2U);
}

TEST(EvenSeries, TakesAWindowOfTime) {
  const EvenSeries series =
      even_series(two_cycles(), "rate", {.from = 20.5, .to = 50.0});
  EXPECT_EQ(series.first, 21.0);
  EXPECT_EQ(series.last, 50.0);
  EXPECT_EQ(series.samples, 9U + 11U);
  EXPECT_EQ(series.left_out, 80U);
  const std::string empty = rejection(
      [] { even_series(two_cycles(), "rate", {.from = 31.0, .to = 39.0}); });
  EXPECT_TRUE(holds(empty, "from 31 to 39 s"));
  EXPECT_THROW(even_series(two_cycles(), "speed"), std::invalid_argument);
}

/// 2,000 samples at times of steps [s] that `step_of` gives.
Recording steps_of(const std::function<double(std::size_t)>& step_of) {
  Recording run = RecordedRun{
      .duration = 2000.0, .step = 1.0, .powered = [](double) {
        return true;
      }}.recording();
  for (std::size_t k = 1; k < run.time.size(); ++k)
    run.time[k] = run.time[k - 1] + step_of(k);
  return run;
}

TEST(EvenSeries, TellsJitterAndGapsFromStepsThatAreNotEven) {
  const auto unevenness = [](const std::function<double(std::size_t)>& step) {
    return even_series(steps_of(step), "rate").unevenness;
  };
  // The golden section spreads numbers evenly from 0 to 1.
  const auto spread = [](std::size_t k) {
    return std::fmod(static_cast<double>(k) * std::numbers::phi, 1.0);
  };
  EXPECT_EQ(unevenness([](std::size_t) { return 1.0; }), 0.0);
  EXPECT_EQ(unevenness([](std::size_t k) { return k % 9 == 0 ? 4.0 : 1.0; }),
            0.0);
  EXPECT_LT(unevenness([&](std::size_t k) { return 0.6 + 0.8 * spread(k); }),
            0.05);
  // Times in whole milliseconds of 700 samples a second.
  EXPECT_LT(unevenness([](std::size_t k) {
              const double at = static_cast<double>(k) / 0.7;
              return std::floor(at + 1.0 / 0.7) - std::floor(at);
            }),
            0.05);
  // Events at random have steps of an exponential distribution.
  EXPECT_GT(unevenness([&](std::size_t k) { return -std::log(spread(k)); }),
            0.05);
  // A clock that slows down without a gap.
  EXPECT_GT(unevenness([](std::size_t k) {
              return std::pow(static_cast<double>(k), 0.2);
            }),
            0.05);
}

// In powers of two, so that every sum is exact: the gaps change nothing.
TEST(EvenSeries, OfASteadyRampHasItsDeviationInEveryStretch) {
  RecordedRun ramp{.duration = 1024.0, .step = 1.0};
  ramp.bias = [](double t) { return t / 64.0; };
  Recording run = ramp.recording();
  const auto whole = even_series(run, "rate");
  run.status[512] = kUnpowered;
  const auto halves = even_series(run, "rate");
  for (const EvenSeries& series : {whole, halves})
    for (const AllanPoint& point :
         allan_curve(series, octave_taus(series)).overlapping)
      EXPECT_NEAR(point.deviation, point.tau / 64.0 / std::sqrt(2.0),
                  1e-9 * point.tau);
  EXPECT_EQ(allan_curve(whole, std::vector{1.0}).plain[0].clusters, 1024U);
  // 512 and 511 samples have 511 and 510 differences.
  EXPECT_EQ(allan_curve(halves, std::vector{1.0}).plain[0].clusters, 1022U);
}

}  // namespace
}  // namespace beamgyro::internal::even_series_test
