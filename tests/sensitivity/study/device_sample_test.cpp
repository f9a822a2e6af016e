// SPDX-License-Identifier: MIT
#include "sensitivity/study/device_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/campaign/distribution.h"
#include "sim/campaign/scrambled_sobol.h"
#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"

namespace beamgyro::internal::device_sample_test {
namespace {

constexpr const char* kTolerances =
    "\"mount.axis_angle_deg\" = { normal = { mean = 0, sigma = 2.5 } }\n"
    "\"readout.offset_tc_deg_per_s_per_K\" = { uniform = { low = -0.02, high = "
    "0.02 } }\n"
    "\"readout.adc_bits\" = { discrete = { values = [12, 16] } }\n";

DeviceSampleOptions options_of(std::size_t rows, unsigned jobs) {
  DeviceSampleOptions options;
  options.merits = {Merit::kBiasPeakToPeak, Merit::kWarmUpChange};
  options.rows = rows;
  options.seed = 9;
  options.halves_tolerances = true;
  options.jobs = jobs;
  return options;
}

double merit_at(const CampaignPlan& campaign, const DrawPlan& plan,
                const std::vector<double>& u) {
  const std::vector<Merit> merits = {Merit::kBiasPeakToPeak};
  return device_merits(*campaign.device_at(plan, u).device, merits, {})[0];
}

TEST(DeviceSample, RowsAreTheNarrowesOfASobolPoint) {
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(kTolerances));
  const DeviceSampleOptions options = options_of(4, 1);
  DeviceSampleCounts counts;
  const DeviceSample sample = sample_devices(campaign, options, counts);
  EXPECT_EQ(sample.devices, devices_of_sample(campaign, options));
  EXPECT_EQ(sample.devices, 4U * (3 + 3 + 2));  // a choice has no half
  const ScrambledSobol sobol(6, 9);
  const auto at = [&](std::size_t dimension) { return sobol.at(2, dimension); };
  const DrawPlan& plan = campaign.device_plan;
  const PickFreezeValues& design = sample.merits[0].design;
  EXPECT_EQ(design.a[2], merit_at(campaign, plan, {at(0), at(1), at(2)}));
  EXPECT_EQ(design.b[2], merit_at(campaign, plan, {at(3), at(4), at(5)}));
  EXPECT_EQ(design.ab[1][2], merit_at(campaign, plan, {at(0), at(4), at(2)}));
  EXPECT_EQ(design.ab[2][2], design.a[2]);  // bits do not touch the bias
  EXPECT_EQ(
      sample.merits[0].halved[1][2],
      merit_at(campaign, with_narrowed(plan, 1, 0.5), {at(0), at(1), at(2)}));
  EXPECT_TRUE(sample.merits[0].halved[2].empty());
  EXPECT_EQ(sample.merits[0].independent[2],
            merit_at(campaign, plan,
                     {sample.numbers[0](2, 0), sample.numbers[1](2, 0),
                      sample.numbers[2](2, 0)}));
}

TEST(DeviceSample, DoesNotDependOnTheNumberOfThreads) {
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(kTolerances));
  DeviceSampleCounts one, three;
  const DeviceSample a = sample_devices(campaign, options_of(16, 1), one);
  const DeviceSample b = sample_devices(campaign, options_of(16, 3), three);
  for (std::size_t m = 0; m < a.merits.size(); ++m) {
    EXPECT_EQ(a.merits[m].design.a, b.merits[m].design.a);
    EXPECT_EQ(a.merits[m].design.ab, b.merits[m].design.ab);
    EXPECT_EQ(a.merits[m].halved, b.merits[m].halved);
    EXPECT_EQ(a.merits[m].independent, b.merits[m].independent);
  }
}

TEST(DeviceSample, ADeviceThatDoesNotWorkIsCounted) {
  // Each of four bonds is below zero with a probability of 2.3 %.
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(
      "\"bond.thickness_m\" = { normal = { mean = 30e-6, sigma = 15e-6 } }\n"
      "\"mount.axis_angle_deg\" = { normal = { mean = 0, sigma = 1 } }\n"));
  DeviceSampleOptions options = options_of(64, 2);
  options.halves_tolerances = false;
  DeviceSampleCounts counts;
  const DeviceSample sample = sample_devices(campaign, options, counts);
  EXPECT_EQ(sample.devices, 64U * 5);
  EXPECT_EQ(sample.failures, counts.failures);
  // 8.8 % of 320 are 28.
  EXPECT_GT(sample.failures, 10U);
  EXPECT_LT(sample.failures, 50U);
  EXPECT_TRUE(holds(sample.first_failure, "bond.thickness_m"));
  std::uint64_t missing = 0;
  const auto count = [&](const std::vector<double>& values) {
    for (const double value : values) missing += std::isnan(value) ? 1U : 0U;
  };
  const MeritSample& merit = sample.merits[0];
  count(merit.design.a);
  count(merit.design.b);
  for (const std::vector<double>& ab : merit.design.ab) count(ab);
  count(merit.independent);
  EXPECT_EQ(missing, sample.failures);
}

TEST(DeviceSample, ADeviceThatCannotBeTrimmedIsCounted) {
  // Patches half a millimetre off couple the modes more than the trim undoes.
  const CampaignFolder folder;
  const CampaignPlan campaign = folder.campaign(with_tolerances(
      "\"patches.offset_m\" = { normal = { mean = 0, sigma = 5e-4 } }\n"
      "\"mount.axis_angle_deg\" = { normal = { mean = 0, sigma = 1 } }\n"));
  DeviceSampleOptions options = options_of(32, 2);
  options.halves_tolerances = false;
  DeviceSampleCounts counts;
  const DeviceSample sample = sample_devices(campaign, options, counts);
  EXPECT_GT(sample.failures, 0U);
  EXPECT_LT(sample.failures, sample.devices);
  EXPECT_TRUE(holds(sample.first_failure, "quadrature trim"));
}

TEST(NarrowedDistribution, EveryValueIsThatMuchNearerToTheCentre) {
  Distribution normal, lognormal, uniform;
  normal.kind = Distribution::Kind::kNormal;
  normal.centre = 5;
  normal.sigma = 2;
  normal.high = 6;
  lognormal.kind = Distribution::Kind::kLognormal;
  lognormal.centre = 5;
  lognormal.sigma = 0.4;
  lognormal.high = 7;
  uniform.low = 3;
  uniform.high = 7;
  for (const double share : {0.5, 0.125})
    for (const double u : {0.01, 0.3, 0.5, 0.9}) {
      EXPECT_NEAR(quantile(narrowed(normal, share), u),
                  5 + share * (quantile(normal, u) - 5), 1e-12);
      EXPECT_NEAR(quantile(narrowed(uniform, share), u),
                  5 + share * (quantile(uniform, u) - 5), 1e-12);
      EXPECT_NEAR(std::log(quantile(narrowed(lognormal, share), u) / 5),
                  share * std::log(quantile(lognormal, u) / 5), 1e-12);
    }
}

}  // namespace
}  // namespace beamgyro::internal::device_sample_test
