// SPDX-License-Identifier: MIT
#include "config/suggestion.h"

#include <gtest/gtest.h>

namespace beamgyro::internal::suggestion_test {
namespace {

const std::vector<std::string> kKeys = {"length_m", "side_m", "loss_factor",
                                        "density_kg_per_m3"};

TEST(Suggestion, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("train", "trian"), 1u);
  EXPECT_EQ(edit_distance("abcd", "badc"), 2u);
}

TEST(Suggestion, IsSymmetric) {
  for (const std::string& a : kKeys) {
    for (const std::string& b : kKeys)
      EXPECT_EQ(edit_distance(a, b), edit_distance(b, a)) << a << ' ' << b;
  }
}

TEST(Suggestion, FindsTheNearestCandidate) {
  EXPECT_EQ(suggestion("lenght_m", kKeys), "length_m");
  EXPECT_EQ(suggestion("sidem", kKeys), "side_m");
  EXPECT_EQ(suggestion("density_kg_per_m2", kKeys), "density_kg_per_m3");
}

TEST(Suggestion, AcceptsAnotherCaseAndAMissingUnit) {
  EXPECT_EQ(suggestion("LENGTH_M", kKeys), "length_m");
  EXPECT_EQ(suggestion("density", kKeys), "density_kg_per_m3");
}

TEST(Suggestion, StaysSilentWhenNothingIsNear) {
  EXPECT_EQ(suggestion("temperature", kKeys), "");
  EXPECT_EQ(suggestion("", kKeys), "");
  EXPECT_EQ(suggestion("x", {"y", "z"}), "");
  EXPECT_EQ(suggestion("length_m", {}), "");
  EXPECT_EQ(suggestion(std::string(100000, 'a'), kKeys), "");
}

TEST(Suggestion, TakesTheFirstOfEquallyNearCandidates) {
  EXPECT_EQ(suggestion("side_k", {"side_a", "side_b"}), "side_a");
}

}  // namespace
}  // namespace beamgyro::internal::suggestion_test
