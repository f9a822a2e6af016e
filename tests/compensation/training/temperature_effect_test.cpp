// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "compensation/training/selection.h"
#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::temperature_effect_test {
namespace {

double no_bias(double /*temperature*/, int /*row*/) { return 0.0; }

// A slope a and an alternating +-c: variance a^2 (n^2 - 1) / 12 + c^2 but for
// their small product, second differences +-4 c, so n s^2 / 20 = 0.4 n c^2.
TEST(MovesMoreThanNoise, ComparesTheVarianceWithSecondDifferences) {
  constexpr int kRows = 120;
  constexpr double c = 0.01;
  const auto moves = [](double a) {
    return moves_more_than_noise(
        rows_of({{0, 0, -40.0, 50.0, kRows}},
                [&](double, int k) { return a * k + (k % 2 == 0 ? c : -c); }));
  };
  const double a = c * std::sqrt(12.0 * (0.4 * kRows - 1.0)) / kRows;
  EXPECT_FALSE(moves(0.97 * a));
  EXPECT_TRUE(moves(1.03 * a));
}

TEST(MovesMoreThanNoise, IsNotSaidOfNoiseNorOfRestNorOfTwoRows) {
  const Leg leg{0, 0, -40.0, 50.0, 200};
  for (std::uint32_t run = 0; run < 20; ++run) {
    const std::vector<double> noise = white(200, run);
    EXPECT_FALSE(moves_more_than_noise(rows_of({leg}, [&](double, int k) {
      return 0.01 * noise[static_cast<std::size_t>(k)];
    })));
  }
  EXPECT_FALSE(moves_more_than_noise(rows_of({leg}, no_bias)));
  const auto steep = [](double T, int) { return T; };
  EXPECT_FALSE(moves_more_than_noise(rows_of({{0, 0, 0.0, 9.0, 2}}, steep)));
  EXPECT_TRUE(moves_more_than_noise(rows_of({{0, 0, 0.0, 9.0, 3}}, steep)));
}

// Turn-on offsets are no second difference.
TEST(MovesMoreThanNoise, LooksAtDifferencesWithinACycle) {
  std::vector<Leg> cycles;
  for (int k = 0; k < 30; ++k) cycles.push_back({k, k, 10.0, 20.0, 3});
  const auto jumps = [](double T, int k) { return T + 100.0 * (k / 3 % 2); };
  EXPECT_TRUE(moves_more_than_noise(rows_of(cycles, jumps)));
}

}  // namespace
}  // namespace beamgyro::internal::temperature_effect_test
