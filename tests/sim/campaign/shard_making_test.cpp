// SPDX-License-Identifier: MIT
#include "sim/campaign/shard_making.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/sim/campaign/campaign_folder.h"

namespace beamgyro::shard_making_test {
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
  Campaign campaign = folder.campaign(about_x("0, 0"));
  const ShardPlan plan(campaign, {"0", "0"});
  ASSERT_FALSE(plan.has_column(0, "true_cross_rate_x"));
  GenerationCounts counts;
  EXPECT_EQ(ShardMaker(plan).make(0, counts).failures.size(), 0U);
  campaign = folder.campaign(about_x("5, 5"));
  try {
    ShardMaker(plan).make(0, counts);
    ADD_FAILURE() << "made a file without true_cross_rate_x";
  } catch (const std::logic_error& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "device 0, run rest: true_cross_rate_x is not among the variables "
        "planned for the set");
  }
}

}  // namespace
}  // namespace beamgyro::shard_making_test
