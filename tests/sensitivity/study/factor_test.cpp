// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "sensitivity/study/device_sample.h"
#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"

namespace beamgyro::internal::factor_test {
namespace {

constexpr const char* kTolerances =
    "\"beam.length_m\" = { uniform = { low = 0.039, high = 0.041 } }\n"
    "\"patches.offset_m\" = { normal = { mean = 0, sigma = 1e-5 } }\n"
    "\"beam.side_m\" = { normal = { mean = 3e-3, sigma = 1e-6 } }\n";

TEST(Factor, AnArrayIsOneFactorOfAllItsElements) {
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(kTolerances));
  const std::vector<Factor> factors = factors_of(campaign.device_plan);
  ASSERT_EQ(factors.size(), 3U);
  EXPECT_EQ(factors[1].key, "patches.offset_m");
  EXPECT_EQ(factors[1].numbers, (std::vector<std::size_t>{1, 2, 3, 4}));
  EXPECT_EQ(factors[2].numbers, (std::vector<std::size_t>{5}));
}

TEST(Factor, CorrelatedKeysAreOneFactor) {
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(
      campaign_text(std::string("[tolerances]\n") + kTolerances +
                    "[[correlated]]\nkeys = [\"beam.length_m\", "
                    "\"beam.side_m\"]\ncorrelation = 0.5\n"));
  const std::vector<Factor> factors = factors_of(campaign.device_plan);
  ASSERT_EQ(factors.size(), 2U);
  EXPECT_EQ(factors[0].key, "beam.length_m + beam.side_m");
  EXPECT_EQ(factors[0].numbers, (std::vector<std::size_t>{0, 5}));
}

TEST(Factor, OneOrNoneCannotBeCompared) {
  const CampaignFolder folder;
  const auto message = [&](const char* tolerances) -> std::string {
    const CampaignPlan campaign = folder.campaign(with_tolerances(tolerances));
    try {
      require_comparable(factors_of(campaign.device_plan), "c.toml");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(holds(message(""), "no device differs"));
  EXPECT_TRUE(
      holds(message("\"patches.offset_m\" = { normal = { mean = 0, sigma = "
                    "1e-5 } }\n"),
            "only patches.offset_m differs"));
  EXPECT_EQ(message(kTolerances), "");
}

}  // namespace
}  // namespace beamgyro::internal::factor_test
