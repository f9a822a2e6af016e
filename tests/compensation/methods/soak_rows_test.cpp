// SPDX-License-Identifier: MIT
#include "compensation/methods/soak_rows.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::soak_rows_test {
namespace {

using Eigen::Index;

// Rows a minute of soaks of 40 minutes at -40, -20, 0, 20 degC, each reached
// within 0.5 K of the end of a ramp [K/min]. Those of ramps follow, but for
// ramps faster than `steady`.
TrainingRows calibration(double ramp, double steady) {
  std::vector<Leg> legs;
  std::vector<double> temperature, time;
  double now = 0.0;
  for (int soak = 0; soak < 4; ++soak) {
    const double target = -40.0 + 20.0 * soak;
    if (soak > 0)
      for (double T = target - 20.0 + ramp; T < target - 0.5; T += ramp) {
        now += 60.0;
        // Noise of the temperature leaves out every third row.
        if (ramp > steady || std::lround(now / 60.0) % 3 == 0) continue;
        temperature.push_back(T);
        time.push_back(now);
      }
    for (int minute = 0; minute < 40; ++minute) {
      now += 60.0;
      temperature.push_back(target - 0.5 * std::exp(-minute / 5.0));
      time.push_back(now);
    }
  }
  TrainingRows rows = rows_of({{0, 0, 0.0, 1.0, static_cast<int>(time.size())}},
                              [](double, int) { return 0.0; });
  for (Index k = 0; k < rows.size(); ++k) {
    rows.temperature(k) = temperature[static_cast<std::size_t>(k)];
    rows.time(k) = time[static_cast<std::size_t>(k)];
  }
  return rows;
}

double farthest_from_a_soak(const TrainingRows& rows) {
  return (rows.temperature / 20.0 - (rows.temperature / 20.0).round())
             .abs()
             .maxCoeff() *
         20.0;
}

TEST(SoakRows, RampsAtTheLimitAreLeftOut) {
  for (const double ramp : {0.2, 0.15, 0.05}) {
    const TrainingRows rows = calibration(ramp, 0.2);
    ASSERT_GT(farthest_from_a_soak(rows), 9.0);
    const TrainingRows soaks = rows_of_soaks(rows, 0.2);
    EXPECT_LT(farthest_from_a_soak(soaks), 1.0) << ramp;
    EXPECT_GT(soaks.size(), 4 * 30) << ramp;
  }
}

TEST(SoakRows, SoaksAloneStay) {
  const TrainingRows rows = calibration(2.0, 0.2);
  EXPECT_EQ(rows_of_soaks(rows, 0.2).size(), rows.size());
}

// Rows a minute of a planned soak with its lag corrected, after a ramp of 2
// K/min: they span 2.2 K, and the last ones are not half as slow as the first.
TEST(SoakRows, ASoakThatSettlesIsNoRamp) {
  TrainingRows rows =
      rows_of({{0, 0, 0.0, 1.0, 27}}, [](double, int) { return 0.0; });
  for (Index k = 0; k < rows.size(); ++k) {
    const Index soak = k / 9;
    const auto minute = static_cast<double>(k % 9);
    rows.time(k) = 60.0 * (static_cast<double>(30 * soak) + minute);
    rows.temperature(k) =
        30.0 - static_cast<double>(30 * soak) - 3.7 * std::exp(-minute / 9.0);
  }
  const TrainingRows soaks = rows_of_soaks(rows, 0.2);
  for (const double last : {8.0, 38.0, 68.0}) {
    EXPECT_TRUE((soaks.time == 60.0 * last).any()) << last;
    EXPECT_FALSE((soaks.time == 60.0 * (last - 8.0)).any()) << last;
  }
  EXPECT_GE(soaks.size(), 9);
}

// A piece of a ramp that is as short goes on as fast.
TEST(SoakRows, APieceOfARampIsNoSoak) {
  TrainingRows rows = calibration(2.0, 0.2);
  const Index first = 40;  // row of the second soak
  for (Index k = 0; k < 12; ++k)
    rows.temperature(first + k) = -26.0 + 0.25 * static_cast<double>(k);
  const TrainingRows soaks = rows_of_soaks(rows, 0.2);
  EXPECT_FALSE((soaks.temperature < -22.0 && soaks.temperature > -39.0).any());
}

// The user's own steady sweep: there is nothing else to take.
TEST(SoakRows, AnEvenSweepStays) {
  const TrainingRows rows =
      rows_of({{0, 0, -40.0, 50.0, 900}}, [](double, int) { return 0.0; });
  EXPECT_EQ(rows_of_soaks(rows, 0.2).size(), rows.size());
}

}  // namespace
}  // namespace beamgyro::internal::soak_rows_test
