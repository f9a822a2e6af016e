// SPDX-License-Identifier: MIT
#include "dataset/log/log_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/config/rejection.h"

namespace beamgyro::internal::log_statistics_test {
namespace {

using Values = std::vector<double>;

std::vector<std::size_t> outliers(const Values& time, const Values& values,
                                  const OutlierRule& rule) {
  const std::vector<bool> found = find_outliers(time, values, rule);
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < found.size(); ++k)
    if (found[k]) rows.push_back(k);
  return rows;
}

Values count(std::size_t samples) {
  Values values(samples);
  for (std::size_t k = 0; k < samples; ++k) values[k] = static_cast<double>(k);
  return values;
}

TEST(LogOutliers, StepsAndBursts) {
  const Values time{0, 1, 2, 7.5, 8.5, 13.5};
  EXPECT_EQ(median_step(time), 1.0);
  EXPECT_EQ(median_step(Values{0, 1, 4}), 2.0);  // mean of the two middle ones
  EXPECT_EQ(median_step(Values{3}), 0.0);
  EXPECT_EQ(burst_starts(time), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(smallest_step(Values{1, 1, 3, std::nan(""), 2.5, 2.5}), 0.5);
  EXPECT_EQ(smallest_step(Values{2, 2}), 0.0);
}

// Window 5 about row 3 of 0, 1, 2, x, 4, 5, 6: median 2 + ... of {1, 2, x, 4,
// 5} is 4 for x >= 4, the deviations are {3, 2, x - 4, 0, 1}, and their median
// 2, so that x is an outlier when x - 4 > k 1.4826 2.
TEST(LogOutliers, TheLimitIsTheEquation) {
  Values values = count(7);
  const double limit = 4 + 3 * 1.4826 * 2;
  values[3] = limit + 1e-9;
  EXPECT_EQ(outliers(count(7), values, {.window = 5, .k = 3}),
            (std::vector<std::size_t>{3}));
  values[3] = limit - 1e-9;
  EXPECT_TRUE(outliers(count(7), values, {.window = 5, .k = 3}).empty());
}

// Most values equal: MAD 0. A step of one resolution is none.
TEST(LogOutliers, TheResolutionIsTheLeastSpread) {
  const Values values{5, 5, 5, 6, 5, 5, 5, 5, 30, 5, 5};
  EXPECT_EQ(outliers(count(11), values, {.window = 5, .k = 3}),
            (std::vector<std::size_t>{8}));
  EXPECT_TRUE(outliers(count(11), values, {.window = 5, .k = 26}).empty());
}

TEST(LogOutliers, AWindowNeverReachesOverAGap) {
  // Two bursts at levels 0 and 100 with a ripple of 1.
  Values time, values;
  for (int k = 0; k < 20; ++k) {
    time.push_back(k + (k >= 10 ? 500 : 0));
    values.push_back((k >= 10 ? 100 : 0) + k % 2);
  }
  EXPECT_TRUE(outliers(time, values, {.window = 9, .k = 5}).empty());
  values[10] = 0;  // of the first burst's level
  EXPECT_EQ(outliers(time, values, {.window = 9, .k = 5}),
            (std::vector<std::size_t>{10}));
}

TEST(LogOutliers, UnpoweredValuesHaveNoPart) {
  Values values = count(9);
  values[2] = values[3] = std::nan("");
  values[4] = 1e6;
  EXPECT_EQ(outliers(count(9), values, {.window = 5, .k = 10}),
            (std::vector<std::size_t>{4}));
}

TEST(LogReport, SamplingInClosedForm) {
  Recording recording;
  recording.time = {0, 1, 2.2, 3, 100, 101};
  // Steps 1, 1.2, 0.8 | 97 | 1: the median is 1, off by 0, 0.2, -0.2, 0.
  const Sampling sampling = sampling_of(recording);
  EXPECT_DOUBLE_EQ(sampling.median_step, 1.0);
  EXPECT_NEAR(sampling.jitter, std::sqrt(0.08 / 4), 1e-15);
  EXPECT_EQ(sampling.bursts, 2u);
  EXPECT_DOUBLE_EQ(sampling.longest_burst, 3.0);
  EXPECT_DOUBLE_EQ(sampling.longest_gap, 97.0);
}

TEST(LogReport, RangeOfAColumnLeavesOutWhatIsNoNumber) {
  Recording recording;
  recording.columns = {
      {"rate", "degree/s", "", Role::kMeasured, {std::nan(""), -2, 3, 2.75}}};
  const ValueRange range = range_of(recording, "rate");
  EXPECT_EQ(range.samples, 3u);
  EXPECT_EQ(range.low, -2.0);
  EXPECT_EQ(range.high, 3.0);
  EXPECT_EQ(range.smallest_step, 0.25);
  EXPECT_NE(rejection([&] { range_of(recording, "time"); }), "");
}

TEST(LogReport, CountsRowsAndTheirFirstLine) {
  LogCounts counts;
  counts.drop(DropReason::kMissing, 9);
  counts.drop(DropReason::kMissing, 4);
  counts.drop(DropReason::kMissing, 12);
  const DroppedRows& missing =
      counts.dropped[static_cast<std::size_t>(DropReason::kMissing)];
  EXPECT_EQ(missing.rows, 3u);
  EXPECT_EQ(missing.first_line, 4u);
}

}  // namespace
}  // namespace beamgyro::internal::log_statistics_test
