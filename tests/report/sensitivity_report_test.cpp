// SPDX-License-Identifier: MIT
#include "report/sensitivity_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/config/rejection.h"

namespace beamgyro::internal::sensitivity_report_test {
namespace {

FactorResult factor(const std::string& key, double first, double total) {
  FactorResult result;
  result.key = key;
  result.first = {first, first - 0.02, first + 0.02};
  result.total = {total, total - 0.02, total + 0.02};
  return result;
}

MeritResult merit(double sum_of_first) {
  MeritResult result;
  result.merit = Merit::kBiasPeakToPeak;
  result.of_logarithm = true;
  result.rows = result.samples = 64;
  result.variance = 1;
  result.sum_of_first = sum_of_first;
  result.factors = {factor("mount.axis_angle_deg", 0.12, 0.73),
                    factor("beam.side_m", 0.07, 0.08)};
  return result;
}

TEST(SensitivityReport, SaysWhenInteractionsDominate) {
  const std::string text = sensitivity_table(merit(0.19));
  EXPECT_TRUE(holds(text,
                    "Sum of the first orders: 0.19. Interactions dominate: "
                    "81 % of the variance"));
  EXPECT_TRUE(
      holds(text, "Mostly together with others: mount.axis_angle_deg.\n"));
  EXPECT_FALSE(holds(sensitivity_table(merit(0.71)), "dominate"));
}

// Each first order is known to 0.02, their sum to 0.028.
TEST(SensitivityReport, InteractionsHaveAnInterval) {
  EXPECT_TRUE(holds(sensitivity_table(merit(0.71)),
                    "interactions 29 % (26 to 32 %).\n"));
  EXPECT_TRUE(
      holds(sensitivity_table(merit(0.98)), "interactions at most 5 %.\n"));
}

// Whether the loops of a device lock is said by a warning.
TEST(SensitivityReport, SaysOfDevicesThatTheyWereComputed) {
  const std::string text = sample_lines(DeviceSample{}, StudyHead{});
  EXPECT_TRUE(holds(text, "\nEvery device was computed.\n")) << text;
}

TEST(SensitivityReport, ALongKeyStandsAboveItsRow) {
  MeritResult result = merit(0.71);
  const std::string key = "readout.offset_tc_deg_per_s_per_K + beam.side_m";
  result.factors.push_back(factor(key, 0.01, 0.02));
  const std::string text = sensitivity_table(result);
  EXPECT_TRUE(holds(text, '\n' + key + '\n'));
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 100U) << text;
    begin = end + 1;
  }
}

TEST(SensitivityReport, AnIndexByRanksMayHaveNoInterval) {
  MeritResult result = merit(0.71);
  result.factors[0].first_by_rank = {0.11, Interval{0.09, 0.13}};
  const std::string text = sensitivity_table(result);
  EXPECT_TRUE(holds(text, " 0.110  0.09 .. 0.13\n"));
  EXPECT_TRUE(holds(text, " 0.000             -\n"));
  const nlohmann::ordered_json json = to_json(DeviceSample{}, {}, {result});
  const auto& indices = json["figures"]["bias_pp_deg_per_s"]["indices"];
  EXPECT_EQ(indices[0]["first_by_rank_interval"][1], 0.13);
  EXPECT_TRUE(indices[1]["first_by_rank_interval"].is_null());
}

TEST(SensitivityReport, SaysWhenNothingVaries) {
  MeritResult result = merit(0);
  result.variance = 0;
  EXPECT_TRUE(holds(sensitivity_table(result), "No tolerance of the campaign"));
}

TEST(SensitivityReport, AYieldOfAChoiceHasNoHalf) {
  MeritResult result = merit(0.71);
  result.yield = {
      10, {0.75, {0.6, 0.9}}, {{"a.b", {{0.9375, {0.8, 1}}}}, {"c.d", {}}}};
  const std::string text = sensitivity_table(result);
  EXPECT_TRUE(holds(text, "as they are"));
  EXPECT_TRUE(holds(text, "a.b/2         93.8 %"));
  EXPECT_TRUE(holds(text, "c.d/2              -\n"));
  const nlohmann::ordered_json json = to_json(DeviceSample{}, {}, {result});
  const auto& found = json["figures"]["bias_pp_deg_per_s"];
  EXPECT_EQ(found["of"], "ln bias_pp_deg_per_s");
  EXPECT_EQ(found["yield"]["as_is"], 0.75);
  EXPECT_TRUE(found["yield"]["halved"][1]["yield"].is_null());
  EXPECT_EQ(found["indices"][0]["total_interval"][1], 0.75);
}

}  // namespace
}  // namespace beamgyro::internal::sensitivity_report_test
