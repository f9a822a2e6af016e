// SPDX-License-Identifier: MIT
#include "sim/numerics/timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace beamgyro::internal::timeline_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Timeline, TimesARoundingApartAreOne) {
  EXPECT_TRUE(is_same_time(0.1 + 0.2, 0.3));
  EXPECT_TRUE(is_same_time(-1e-17, 0));
  EXPECT_TRUE(is_same_time(1e8, std::nextafter(1e8, kInfinity)));
  EXPECT_FALSE(is_same_time(1, 1 + 2e-9));
  EXPECT_FALSE(is_same_time(1, kInfinity));
}

TEST(Timeline, PiecesJoinAtEveryBorderInside) {
  const std::vector<Piece> pieces = pieces_until(
      10, {{7}, {3, true}, {-1, true}, {7}, {kInfinity, true}, {11}});
  ASSERT_EQ(pieces.size(), 3);
  const double starts[] = {0, 3, 7}, ends[] = {3, 7, 10};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].start, starts[i]);
    EXPECT_EQ(pieces[i].end, ends[i]);
    EXPECT_EQ(pieces[i].jump, i == 1);
  }
}

TEST(Timeline, ABorderOfManyEndsAtItsFirstAndStartsAtItsLast) {
  const double early = std::nextafter(5.0, 0.0),
               late = std::nextafter(5.0, 9.0);
  for (const bool first_jumps : {true, false}) {
    const std::vector<Piece> pieces =
        pieces_until(9, {{late, !first_jumps}, {5}, {early, first_jumps}});
    ASSERT_EQ(pieces.size(), 2);
    EXPECT_EQ(pieces[0].end, early);
    EXPECT_EQ(pieces[1].start, late);
    EXPECT_TRUE(pieces[1].jump);
  }
}

TEST(Timeline, BordersARoundingFromEitherEndMakeNoPiece) {
  const std::vector<Piece> pieces =
      pieces_until(9, {{1e-17, true}, {std::nextafter(9.0, 0.0), true}});
  ASSERT_EQ(pieces.size(), 1);
  EXPECT_EQ(pieces[0].start, 1e-17);
  EXPECT_TRUE(pieces_until(0, {{0, true}}).empty());
}

TEST(SampleGrid, FindsTheFirstSampleFromATimeOn) {
  // Of these rates k / rate x rate often is not k.
  for (const double rate : {10.0, 0.3, 7.3, 1e5 / 3}) {
    const SampleGrid grid{rate, 1000};
    for (std::size_t k = 1; k < grid.count; ++k) {
      EXPECT_EQ(grid.first_from(grid.time(k)), k);
      EXPECT_EQ(grid.first_from(std::nextafter(grid.time(k), 0.0)), k);
      EXPECT_EQ(grid.first_from(std::nextafter(grid.time(k), 1e9)), k + 1);
    }
    EXPECT_EQ(grid.first_from(-1), 0);
    EXPECT_EQ(grid.first_from(0), 0);
    EXPECT_EQ(grid.first_from(1e12), 1000);
    EXPECT_EQ(grid.times(7, 2),
              (std::vector<double>{grid.time(7), grid.time(8)}));
  }
}

}  // namespace
}  // namespace beamgyro::internal::timeline_test
