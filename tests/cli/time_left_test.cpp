// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "cli/progress.h"

namespace beamgyro::internal::time_left_test {
namespace {

TEST(TimeLeft, IsUnknownBeforeTheWorkAdvances) {
  TimeLeft left;
  EXPECT_FALSE(left.seconds());
  left.note(3, 0);
  EXPECT_FALSE(left.seconds());
}

TEST(TimeLeft, OfEvenWorkIsExact) {
  TimeLeft left;
  for (double t = 0.2; t < 100; t += 0.2) {
    left.note(t, t / 100);
    EXPECT_NEAR(*left.seconds(), 100 - t, 1e-9);  // rounding
  }
}

// 10 % in the first 50 s, the rest at ten times that speed: over at 95 s.
TEST(TimeLeft, ForgetsASlowStart) {
  TimeLeft left;
  for (double t = 0.2; t < 94.9; t += 0.2) {
    left.note(t, t < 50 ? t / 500 : 0.1 + (t - 50) / 50);
  }
  // 0.9 s before the end the last half, from 47 s on, is nearly all fast.
  EXPECT_NEAR(*left.seconds(), 0.2, 0.1);
}

// A result every 10 s: of those in the last half of the time, t / 20, one more
// or less has been seen, and one may be due now.
TEST(TimeLeft, OfWorkInStepsConverges) {
  TimeLeft left;
  for (double t = 0.2; t < 199; t += 0.2) {
    left.note(t, std::floor(t / 10) / 20);
    if (t < 20) continue;
    EXPECT_NEAR(*left.seconds(), 200 - t, (200 - t) * 20 / t + 12) << t;
  }
}

TEST(TimeLeft, IsShownAsAClock) {
  EXPECT_EQ(clock_text(0), "0:00:00");
  EXPECT_EQ(clock_text(59.99), "0:00:59");
  EXPECT_EQ(clock_text(3600 * 26 + 61), "26:01:01");
}

}  // namespace
}  // namespace beamgyro::internal::time_left_test
