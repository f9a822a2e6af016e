// SPDX-License-Identifier: MIT
#include "sim/campaign/spurious_population.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "config/units.h"
#include "sim/campaign/campaign.h"
#include "sim/campaign/shard_making.h"
#include "sim/device/device_file.h"
#include "sim/dynamics/gyro.h"
#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"

namespace beamgyro::internal::spurious_population_test {
namespace {

constexpr const char* kCount =
    "count = { poisson = { mean = 8, high = 16 } }\n";
constexpr const char* kOfMode =
    "detuning = { uniform = { low = -0.03, high = 0.03 } }\n"
    "detuning_tc_per_K = { lognormal = { median = 3e-4, sigma = 0.6, "
    "either_sign = true } }\n"
    "loss_factor = { lognormal = { median = 2e-3, sigma = 0.5 } }\n"
    "height_deg_per_s = { lognormal = { median = 0.03, sigma = 1, "
    "either_sign = true } }\n";
constexpr const char* kRatio =
    "coupling_ratio = { lognormal = { median = 1, sigma = 1 } }\n";

CampaignPlan population(const CampaignFolder& folder,
                        const std::string& tables) {
  return folder.campaign(
      campaign_text("[spurious_modes]\n" + tables, "devices_per_file = 10"));
}

TEST(SpuriousPopulation, HasThePoissonNumberOfModes) {
  const CampaignFolder folder;
  const CampaignPlan c =
      population(folder, std::string(kCount) + kOfMode + kRatio);
  constexpr int kUnits = 2000;
  double sum = 0, squares = 0;
  for (std::uint32_t i = 0; i < kUnits; ++i) {
    const VirtualDevice unit = c.device(i);
    ASSERT_TRUE(unit.device) << unit.failure;
    const auto count = static_cast<double>(unit.device->spurious_modes.size());
    EXPECT_EQ(count, unit.parameters[0]);
    sum += count;
    squares += count * count;
  }
  // Cut at 16 the mean is 7.964 and the variance 7.673; three sigma of each.
  const double mean = sum / kUnits;
  EXPECT_NEAR(mean, 7.964, 3 * std::sqrt(7.673 / kUnits));
  EXPECT_NEAR(squares / kUnits - mean * mean, 7.673,
              3 * 7.673 * std::sqrt(1.813 / kUnits));
}

TEST(SpuriousPopulation, CouplingsHaveTheDrawnHeightAndRatio) {
  const CampaignFolder folder;
  const CampaignPlan c =
      population(folder, std::string(kCount) + kOfMode + kRatio);
  int below = 0, negative = 0, falling = 0, modes = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const VirtualDevice unit = c.device(i);
    const double* number = unit.parameters.data() + 1;
    for (const SpuriousModeParameters& mode : unit.device->spurious_modes) {
      // (13.4) with w_0 and gamma of the base unit.
      const TrimmedGyro base = make_gyro(c.base_device);
      const double w_0 =
          beam_signal(base, kCalibrationTemperature, {}).drive_frequency;
      const double height = mode.coupling_drive * mode.coupling_sense * w_0 /
                            (2 * mode.loss_factor * base.beam.angular_gain);
      EXPECT_EQ(mode.detuning, number[kDetuning]);
      EXPECT_EQ(mode.detuning_tc, number[kDetuningTc]);
      EXPECT_NEAR(height / kDegree / number[kHeight], 1, 1e-9);
      EXPECT_NEAR(std::abs(mode.coupling_drive / mode.coupling_sense) /
                      number[kCouplingRatio],
                  1, 1e-9);
      EXPECT_GT(mode.coupling_drive, 0);
      below += std::abs(number[kHeight]) < 0.03;
      negative += number[kHeight] < 0;
      falling += number[kDetuningTc] < 0;
      number += kSpuriousNumbers;
      if (++modes == 400) break;
    }
    if (modes == 400) break;
  }
  // Halves of 400, three sigma.
  for (const int half : {below, negative, falling}) EXPECT_NEAR(half, 200, 30);
}

TEST(SpuriousPopulation, TheOverridesMakeTheSameUnit) {
  const CampaignFolder folder;
  const CampaignPlan c = population(
      folder, std::string(kCount) + kOfMode + kRatio + "follows = \"housing\"");
  const VirtualDevice unit = c.device(4);
  const std::string line = unit.overrides.substr(0, unit.overrides.find('\n'));
  const Overrides overrides(std::vector<std::string>{line});
  const DeviceParameters again =
      read_device(c.device_document->with(overrides));
  ASSERT_EQ(again.spurious_modes.size(), unit.device->spurious_modes.size());
  for (std::size_t i = 0; i < again.spurious_modes.size(); ++i) {
    EXPECT_EQ(again.spurious_modes[i].coupling_sense,
              unit.device->spurious_modes[i].coupling_sense);
    EXPECT_TRUE(again.spurious_modes[i].follows_housing);
  }
}

// Two of three units have no mode; their truth is 0.
TEST(SpuriousPopulation, EveryUnitOfASetHasTheTruth) {
  const CampaignFolder folder;
  const CampaignPlan c = population(
      folder,
      std::string("count = { discrete = { values = [0, 4], weights = [2, 1] } "
                  "}\n") +
          kOfMode + kRatio);
  const ShardPlan plan(c, {"0", "0"});
  ASSERT_TRUE(plan.has_column(0, "true_spurious_bias"));
  GenerationCounts counts;
  const MadeShard shard = ShardMaker(plan).make(0, counts);
  EXPECT_EQ(shard.failures.size(), 0U);
}

TEST(SpuriousPopulation, WhatIsWrongIsRefused) {
  const CampaignFolder folder;
  const auto why = [&](const std::string& tables) {
    return rejection([&] { population(folder, tables); });
  };
  const std::string of_mode = kOfMode;
  EXPECT_TRUE(holds(why(of_mode + kRatio), "count"));
  EXPECT_TRUE(holds(why(kCount + of_mode), "coupling_ratio"));
  EXPECT_TRUE(holds(
      why("count = { poisson = { mean = 8, high = 17 } }\n" + of_mode + kRatio),
      "17 is no number of modes"));
  EXPECT_TRUE(holds(
      why("count = { uniform = { low = 0, high = 8 } }\n" + of_mode + kRatio),
      "expected a whole number"));
  EXPECT_TRUE(holds(why(kCount + of_mode +
                        "coupling_ratio = { normal = { mean = 1, sigma = 1 } "
                        "}\n"),
                    "is a ratio of magnitudes"));
  EXPECT_TRUE(holds(
      rejection([&] {
        folder.campaign(campaign_text(
            "[tolerances]\n\"spurious_mode.a.detuning\" = { uniform = { low = "
            "0, high = 1e-3 } }\n[spurious_modes]\n" +
            std::string(kCount) + of_mode + kRatio));
      }),
      "spurious_mode"));
}

}  // namespace
}  // namespace beamgyro::internal::spurious_population_test
