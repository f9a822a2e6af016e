// SPDX-License-Identifier: MIT
#include "sim/campaign/shard_making.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"

namespace beamgyro::internal::shard_making_test {
namespace {

std::string about_x(const std::string& rates) {
  return campaign_text(
      "", "devices_per_file = 10",
      "[run.vary]\n\"cross_rate.x.constant_deg_per_s\" = { discrete = { values "
      "= [" +
          rates + "] } }\n");
}

// A plan takes devices from its campaign: one that changes after the plan was
// made gives recordings that the plan does not foresee.
TEST(ShardMaking, RefusesAVariableThatWasNotPlanned) {
  const CampaignFolder folder;
  CampaignPlan campaign = folder.campaign(about_x("0, 0"));
  const ShardPlan plan(campaign, {"0", "0"});
  ASSERT_FALSE(plan.has_column(0, "true_cross_rate_x"));
  GenerationCounts counts;
  EXPECT_EQ(ShardMaker(plan).make(0, counts).failures.size(), 0U);
  campaign = folder.campaign(about_x("5, 5"));
  EXPECT_EQ(
      rejection<std::logic_error>([&] { ShardMaker(plan).make(0, counts); }),
      "device 0, run rest: true_cross_rate_x is not among the variables "
      "planned for the set");
}

// The base device has no errors of its channels, so its recording does not show
// that the others have.
TEST(ShardMaking, HasTheTrueDriveFrequencyWhereItsErrorsAreDrawn) {
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(
      "\"loop_channels.clock_offset_ppm\" = { uniform = { low = 5, high = 9 } "
      "}\n",
      "devices_per_file = 10"));
  const ShardPlan plan(campaign, {"0", "0"});
  ASSERT_TRUE(plan.has_column(0, "true_drive_frequency"));
  GenerationCounts counts;
  EXPECT_EQ(ShardMaker(plan).make(0, counts).failures.size(), 0U);
  EXPECT_EQ(counts.device_runs, 10U);
  const ShardHead head = plan.head_of(0);
  const auto found = std::ranges::find(head.variables, "true_drive_frequency",
                                       &SetVariable::name);
  ASSERT_NE(found, head.variables.end());
  EXPECT_EQ(found->storage, Storage::kFloat64);
  EXPECT_EQ(campaign.device_plan.parameters[0].units, "1e-6");
}

}  // namespace
}  // namespace beamgyro::internal::shard_making_test
