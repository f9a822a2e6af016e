// SPDX-License-Identifier: MIT
#include "compensation/rows/row_groups.h"

#include <gtest/gtest.h>

#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::row_groups_test {
namespace {

double no_bias(double /*temperature*/, int /*row*/) { return 0.0; }

std::vector<int> groups_by(const TrainingRows& rows, Grouping by) {
  const RowGroups groups = group_rows(rows, by);
  return {groups.of_row.begin(), groups.of_row.end()};
}

TEST(RowGroups, AreRunsCyclesOrLegs) {
  const TrainingRows rows = rows_of({{0, 0, 0.0, 9.0, 2},
                                     {0, 0, 9.0, 0.0, 2},
                                     {0, 1, 0.0, 9.0, 2},
                                     {1, 2, 0.0, 9.0, 2}},
                                    no_bias);
  EXPECT_EQ(groups_by(rows, Grouping::kRun),
            (std::vector{0, 0, 0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(groups_by(rows, Grouping::kCycle),
            (std::vector{0, 0, 0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(groups_by(rows, Grouping::kLeg),
            (std::vector{0, 0, 1, 1, 2, 2, 3, 3}));
}

TEST(RowGroups, OfOneRowJoinTheOneBefore) {
  const TrainingRows rows = rows_of({{0, 0, 0.0, 9.0, 1},
                                     {0, 0, 9.0, 0.0, 1},
                                     {0, 0, 0.0, 9.0, 3},
                                     {0, 0, 9.0, 0.0, 1}},
                                    no_bias);
  EXPECT_EQ(groups_by(rows, Grouping::kLeg), (std::vector{0, 0, 1, 1, 1, 1}));
}

TEST(RowGroups, SegmentsAreEveryFifthOfTwentyPieces) {
  const TrainingRows rows = rows_of({{0, 0, 0.0, 90.0, 60}}, no_bias);
  const RowGroups groups = group_rows(rows, Grouping::kSegment);
  EXPECT_EQ(groups.count, 5);
  for (int k = 0; k < 60; ++k) EXPECT_EQ(groups.of_row(k), k / 3 % 5);
}

TEST(RowGroups, OfFewRowsHaveNoEmptySegment) {
  const TrainingRows rows = rows_of({{0, 0, 0.0, 90.0, 3}}, no_bias);
  EXPECT_EQ(group_rows(rows, Grouping::kSegment).count, 3);
  EXPECT_EQ(groups_by(rows, Grouping::kSegment), (std::vector{0, 1, 2}));
}

TEST(OthersCover, WhatNoGroupHoldsAlone) {
  const auto covered = [](const std::vector<Leg>& legs) {
    const TrainingRows rows = rows_of(legs, no_bias);
    return others_cover(rows, group_rows(rows, Grouping::kLeg));
  };
  const Leg up{0, 0, -40.0, 50.0, 91}, down{0, 0, 50.0, -40.0, 91};
  EXPECT_TRUE(covered({up, down}));
  EXPECT_FALSE(covered({up}));
  // Alone in 2 of 10 tenths of the span, and in 3.
  EXPECT_TRUE(covered({up, {0, 0, 31.0, -40.0, 91}}));
  EXPECT_FALSE(covered({up, {0, 0, 22.0, -40.0, 91}}));
  // Everywhere one of two.
  EXPECT_FALSE(covered({{0, 0, -40.0, 4.9, 45}, {0, 0, 5.1, 50.0, 45}}));
  EXPECT_TRUE(covered({{0, 0, 20.0, 20.0, 9}}));
}

TEST(Folds, AreTheCoarsestWithoutAHoleInTheTemperatures) {
  const auto folds = [](const std::vector<Leg>& legs) {
    return folds_of(rows_of(legs, no_bias), 3);
  };
  const auto up = [](int run, int cycle) {
    return Leg{run, cycle, -40.0, 50.0, 91};
  };
  const auto down = [](int run, int cycle) {
    return Leg{run, cycle, 50.0, -40.0, 91};
  };
  EXPECT_EQ(folds({up(0, 0), up(1, 1), up(2, 2)}).by, Grouping::kRun);
  EXPECT_EQ(folds({up(0, 0), up(0, 1), up(1, 2)}).by, Grouping::kCycle);
  EXPECT_EQ(folds({up(0, 0), down(0, 0), up(1, 1)}).by, Grouping::kLeg);
  // Two warm-ups say nothing of a ramp, but its way back does.
  const Leg cold{1, 1, -40.0, -35.0, 60}, warm{2, 2, 25.0, 30.0, 60};
  EXPECT_EQ(folds({up(0, 0), cold, warm}).by, Grouping::kSegment);
  EXPECT_EQ(folds({up(0, 0), down(0, 0), cold, warm}).by, Grouping::kLeg);
}

TEST(Folds, AreTwoLegsOnlyIfEachCoversTheTemperatures) {
  const RowGroups two = folds_of(
      rows_of({{0, 0, -40.0, 50.0, 91}, {0, 0, 50.0, -40.0, 91}}, no_bias), 3);
  EXPECT_EQ(two.by, Grouping::kLeg);
  EXPECT_EQ(two.count, 2);
  const RowGroups warm_up_and_fall = folds_of(
      rows_of({{0, 0, 50.0, 55.0, 60}, {0, 0, 55.0, -40.0, 91}}, no_bias), 3);
  EXPECT_EQ(warm_up_and_fall.by, Grouping::kSegment);
  EXPECT_EQ(warm_up_and_fall.count, 5);
}

// Self-heating at the chamber's first temperature, before it cools.
TEST(Folds, CountNoShortLegThatALongOneOfItsPowerCycleFollows) {
  const Leg up{0, 0, -40.0, 50.0, 91}, heating{1, 1, 50.0, 54.0, 20},
      down{1, 1, 54.0, -40.0, 91}, rest{1, 1, -40.0, -38.0, 20};
  const TrainingRows rows = rows_of({up, heating, down, rest}, no_bias);
  const RowGroups groups = folds_of(rows, 3);
  EXPECT_EQ(groups.by, Grouping::kLeg);
  EXPECT_EQ(groups.count, 2);
  EXPECT_TRUE((groups.of_row.head(91) == 0).all());
  EXPECT_TRUE((groups.of_row.tail(131) == 1).all());
}

TEST(CoarsestGroups, MayLeaveAHole) {
  const std::vector<Leg> rests = {
      {0, 0, -40.0, -40.0, 9}, {1, 1, 5.0, 5.0, 9}, {2, 2, 50.0, 50.0, 9}};
  const TrainingRows rows = rows_of(rests, no_bias);
  EXPECT_EQ(coarsest_groups(rows, 3).by, Grouping::kRun);
  EXPECT_EQ(coarsest_groups(rows, 4).by, Grouping::kSegment);
  EXPECT_EQ(folds_of(rows, 3).by, Grouping::kSegment);
}

}  // namespace
}  // namespace beamgyro::internal::row_groups_test
