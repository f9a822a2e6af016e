// SPDX-License-Identifier: MIT
#include "compensation/inputs/sample_ranges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::sample_ranges_test {
namespace {

using testing::ElementsAre;

std::vector<std::size_t> sizes(const std::vector<SampleRange>& ranges) {
  std::vector<std::size_t> all;
  for (const SampleRange& range : ranges) {
    all.push_back(range.size());
  }
  return all;
}

TEST(SampleRanges, BlocksOfSixtySecondsHoldTheSamplesOfSixtySeconds) {
  const Recording run = RecordedRun{.duration = 180.0, .step = 0.1}.recording();
  EXPECT_THAT(sizes(score_blocks(run)), ElementsAre(600, 600, 600));
}

TEST(SampleRanges, BlocksDoNotFeelTheRoundingOfTheTimeAxis) {
  Recording run = RecordedRun{.duration = 180.0, .step = 0.1}.recording();
  for (std::size_t k = 1; k < run.time.size(); ++k) {
    run.time[k] = run.time[k - 1] + 0.1;
  }
  ASSERT_NE(run.time[600], 60.0);
  EXPECT_THAT(sizes(score_blocks(run)), ElementsAre(600, 600, 600));
}

TEST(SampleRanges, ARemainderCountsFromHalfABlockOn) {
  const Recording half = RecordedRun{.duration = 90.0, .step = 0.1}.recording();
  EXPECT_THAT(sizes(score_blocks(half)), ElementsAre(600, 300));
  const Recording less = RecordedRun{.duration = 89.0, .step = 0.1}.recording();
  EXPECT_THAT(sizes(score_blocks(less)), ElementsAre(600));
}

TEST(SampleRanges, AShortStretchIsOneBlock) {
  const Recording run = RecordedRun{.duration = 7.0, .step = 1.0}.recording();
  EXPECT_THAT(score_blocks(run), ElementsAre(SampleRange{0, 7}));
}

TEST(SampleRanges, BlocksStartAnewAtEachPowerOn) {
  const Recording run = RecordedRun{
      .duration = 300.0, .step = 1.0, .powered = [](double t) {
        return (t >= 10.0 && t < 80.0) || t >= 100.0;
      }}.recording();
  EXPECT_THAT(powered_stretches(run),
              ElementsAre(SampleRange{10, 80}, SampleRange{100, 300}));
  EXPECT_THAT(score_blocks(run),
              ElementsAre(SampleRange{10, 70}, SampleRange{100, 160},
                          SampleRange{160, 220}, SampleRange{220, 280}));
}

TEST(SampleRanges, LostSamplesDoNotShiftTheBlocksAfterThem) {
  Recording run = RecordedRun{.duration = 180.0, .step = 1.0}.recording();
  for (Column& column : run.columns) {
    column.values.erase(column.values.begin() + 70,
                        column.values.begin() + 110);
  }
  run.time.erase(run.time.begin() + 70, run.time.begin() + 110);
  run.status.erase(run.status.begin() + 70, run.status.begin() + 110);
  // 20 of the 60 samples of the middle block are left: too few.
  EXPECT_THAT(score_blocks(run),
              ElementsAre(SampleRange{0, 60}, SampleRange{80, 140}));
}

TEST(SampleRanges, EveryBurstIsABlock) {
  Recording run = RecordedRun{.duration = 1000.0, .step = 1.0}.recording();
  // Five samples every 100 s; the last burst is cut short.
  const auto thin = [](auto& values) {
    std::size_t to = 0;
    for (std::size_t k = 0; k < 902; ++k)
      if (k % 100 < 5) values[to++] = values[k];
    values.resize(to);
  };
  for (Column& column : run.columns) thin(column.values);
  thin(run.time);
  thin(run.status);
  ASSERT_EQ(run.time.size(), 47u);
  const std::vector<SampleRange> blocks = score_blocks(run);
  ASSERT_EQ(blocks.size(), 9u);
  EXPECT_EQ(blocks.front(), (SampleRange{0, 5}));
  EXPECT_EQ(blocks.back(), (SampleRange{40, 45}));
}

TEST(SampleRanges, PlateausAreCutWhereTheTemperatureHasMovedByHalfAKelvin) {
  const Recording run = RecordedRun{
      .duration = 100.0, .step = 1.0, .temperature = [](double t) {
        return t < 50.0 ? 20.0 : 20.0 + 0.125 * (t - 50.0);
      }}.recording();
  const auto plateaus = temperature_plateaus(run);
  EXPECT_EQ(plateaus.front(), (SampleRange{0, 54}));
  EXPECT_EQ(plateaus[1], (SampleRange{54, 58}));
  EXPECT_EQ(plateaus.back().end, 100U);
}

TEST(SampleRanges, RefusesAStatusOfAnotherLength) {
  Recording run = RecordedRun{.duration = 10.0}.recording();
  run.status.pop_back();
  EXPECT_THROW(powered_stretches(run), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::sample_ranges_test
