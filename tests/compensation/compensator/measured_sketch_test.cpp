// SPDX-License-Identifier: MIT
#include "compensation/compensator/measured_sketch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/compensation/recorded_run.h"
#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::measured_sketch_test {
namespace {

constexpr int kSamples = 2000;

Recording noisy_run(std::uint32_t number) {
  const std::vector<double> noise = white(kSamples + 1, number);
  RecordedRun run{.duration = kSamples, .step = 1.0};
  run.bias = [&noise](double t) {
    return noise[static_cast<std::size_t>(std::lround(t))];
  };
  return run.recording();
}

void keep(Recording& run, std::size_t begin, std::size_t end) {
  const auto part = [&](auto& values) {
    values = {values.begin() + static_cast<std::ptrdiff_t>(begin),
              values.begin() + static_cast<std::ptrdiff_t>(end)};
  };
  part(run.time);
  part(run.status);
  for (Column& column : run.columns) part(column.values);
}

bool is_recognised(const Recording& trained_on, const Recording& run) {
  const MeasuredSketch sketch = measured_sketch(trained_on);
  EXPECT_EQ(sketch.size(), 32U);
  EXPECT_TRUE(std::ranges::is_sorted(sketch));
  return shares_stretches(sketch, stretches_up_to(sketch.back(), run));
}

TEST(MeasuredSketch, KnowsARecordingByItsParts) {
  const Recording whole = noisy_run(1);
  EXPECT_TRUE(is_recognised(whole, whole));
  const auto known = [&whole](const auto& change) {
    Recording run = whole;
    change(run);
    return is_recognised(whole, run);
  };
  EXPECT_TRUE(known([](Recording& run) { keep(run, 600, 1500); }));
  EXPECT_TRUE(known([](Recording& run) {
    for (double& time : run.time) time += 3600.0;
  }));
  EXPECT_TRUE(known([](Recording& run) {
    for (Column& column : run.columns) std::ranges::reverse(column.values);
  }));
  EXPECT_TRUE(known([](Recording& run) {
    run.time.erase(run.time.begin() + 1000);
    run.status.pop_back();
    for (Column& column : run.columns)
      column.values.erase(column.values.begin() + 1000);
  }));
  // One sample in a hundred: a third of the stretches hold one.
  EXPECT_TRUE(known([](Recording& run) {
    for (Column& column : run.columns)
      for (std::size_t k = 50; k < kSamples; k += 100) column.values[k] += 1e-9;
  }));
  EXPECT_FALSE(known([](Recording& run) {
    for (Column& column : run.columns)
      for (double& value : column.values) value += 1e-9;
  }));
}

TEST(MeasuredSketch, KnowsNoOtherRecording) {
  EXPECT_FALSE(is_recognised(noisy_run(1), noisy_run(2)));
  // Of 200 samples of 2000 too few hashes are below the last of the sketch.
  Recording tenth = noisy_run(1);
  keep(tenth, 600, 800);
  EXPECT_FALSE(is_recognised(noisy_run(1), tenth));
  // Twice as much of another run as of the one that is known.
  Recording longer = noisy_run(2), part = noisy_run(1);
  keep(part, 0, 900);
  for (double& time : part.time) time += kSamples + 1.0;
  longer.time.insert(longer.time.end(), part.time.begin(), part.time.end());
  longer.status.insert(longer.status.end(), part.status.begin(),
                       part.status.end());
  for (std::size_t c = 0; c < longer.columns.size(); ++c)
    longer.columns[c].values.insert(longer.columns[c].values.end(),
                                    part.columns[c].values.begin(),
                                    part.columns[c].values.end());
  EXPECT_FALSE(is_recognised(noisy_run(1), longer));
}

TEST(MeasuredSketch, IsEmptyWithoutNoiseToTellDaysApart) {
  EXPECT_TRUE(
      measured_sketch(RecordedRun{.duration = 2000.0}.recording()).empty());
  Recording brief = noisy_run(1);
  keep(brief, 0, 40);
  EXPECT_TRUE(measured_sketch(brief).empty());
}

}  // namespace
}  // namespace beamgyro::internal::measured_sketch_test
