// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "sim/campaign/campaign.h"
#include "sim/dynamics/gyro.h"
#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"
#include "tests/sim/campaign/kolmogorov_smirnov.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::draws_test {
namespace {

constexpr const char* kOffset =
    "\"patches.offset_m\" = { normal = { mean = 0, sigma = 10e-6 } }\n";
constexpr const char* kTransitions =
    "\"mount.glass_transition_degC\" = { normal = { mean = -48, sigma = 4 } }\n"
    "\"bond.glass_transition_degC\" = { uniform = { low = 30, high = 46 } }\n";

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

void expect_same_unit(const DeviceParameters& a, const DeviceParameters& b) {
  const TrimmedGyro x = make_gyro(a), y = make_gyro(b);
  EXPECT_EQ(a.patches.offset, b.patches.offset);
  EXPECT_EQ(a.bond.thickness, b.bond.thickness);
  EXPECT_EQ(a.readout.quadrature_trim, b.readout.quadrature_trim);
  EXPECT_EQ(a.readout.offset_trim, b.readout.offset_trim);
  EXPECT_EQ(a.readout.scale_factor_error, b.readout.scale_factor_error);
  EXPECT_EQ(a.readout.adc_bits, b.readout.adc_bits);
  EXPECT_EQ(a.readout.mode, b.readout.mode);
  EXPECT_EQ(x.stiffness_trim, y.stiffness_trim);
  EXPECT_EQ(x.rate_axis, y.rate_axis);
  EXPECT_EQ(x.offset, y.offset);
}

class EitherSampling : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Samplings, EitherSampling,
                         testing::Values("monte_carlo", "sobol"));

std::string sampling(const std::string& name) {
  return "sampling = \"" + name + "\"\n";
}

TEST(Draws, AnotherToleranceLeavesTheOthersAsTheyAre) {
  const CampaignFolder folder;
  const CampaignPlan few = folder.campaign(with_tolerances(kOffset));
  const CampaignPlan more = folder.campaign(with_tolerances(
      kTransitions +
      std::string("\"readout.adc_bits\" = { discrete = { values = [14, 16] } "
                  "}\n") +
      kOffset));
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::vector<double> a = few.device(i).parameters;
    const std::vector<double> b = more.device(i).parameters;
    EXPECT_EQ(a, std::vector<double>(b.begin() + 3, b.end()));
    EXPECT_NE(a[0], a[1]);
    EXPECT_NE(a, few.device(i + 1).parameters);
  }
}

TEST_P(EitherSampling, DevicesAreTheSameInAnyOrderAndThread) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(with_tolerances(
      std::string(kOffset) + kTransitions, sampling(GetParam())));
  constexpr std::uint32_t kDevices = 64;
  std::vector<std::string> forward, backward(kDevices);
  for (std::uint32_t i = 0; i < kDevices; ++i)
    forward.push_back(c.device(i).overrides);
  std::vector<std::thread> threads;
  for (std::uint32_t part = 0; part < 4; ++part) {
    threads.emplace_back([&, part] {
      for (std::uint32_t i = kDevices; i-- > 0;) {
        if (i % 4 == part) backward[i] = c.device(i).overrides;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(forward, backward);
}

TEST_P(EitherSampling, OverridesMakeTheSameUnitFromTheDeviceFile) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(campaign_text(
      "[tolerances]\n" + std::string(kOffset) +
          "\"readout.adc_bits\" = { discrete = { values = [14, 16] } }\n"
          "\"readout.mode\" = { discrete = { values = [\"open_loop\", "
          "\"force_rebalance\"] } }\n",
      sampling(GetParam())));
  bool modes[2] = {false, false};
  for (std::uint32_t i = 0; i < 12; ++i) {
    const VirtualDevice unit = c.device(i);
    ASSERT_TRUE(unit.device) << unit.failure;
    EXPECT_EQ(lines(unit.overrides).size(), 3u);
    expect_same_unit(*unit.device, nominal_device(lines(unit.overrides)));
    EXPECT_EQ(unit.parameters[0], unit.device->patches.offset[0]);
    EXPECT_EQ(unit.parameters[4], unit.device->readout.adc_bits);
    EXPECT_EQ(unit.parameters[5],
              unit.device->readout.mode == ReadoutMode::kForceRebalance);
    modes[unit.parameters[5] == 1] = true;
  }
  EXPECT_TRUE(modes[0] && modes[1]);
}

TEST(Draws, OverridesHoldWhatWasNotTrimmed) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(campaign_text(
      "[tolerances]\n" + std::string(kOffset) + kTransitions +
      "[trims]\nquadrature = false\noffset = false\nscale_factor = false\n"));
  const TrimmedGyro base = make_gyro(c.base_device);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const VirtualDevice unit = c.device(i);
    ASSERT_TRUE(unit.device) << unit.failure;
    EXPECT_EQ(lines(unit.overrides).size(), 6u);
    expect_same_unit(*unit.device, nominal_device(lines(unit.overrides)));
    const TrimmedGyro gyro = make_gyro(*unit.device);
    EXPECT_NEAR(gyro.offset, base.offset, 1e-9);
    EXPECT_NE(unit.device->readout.offset_trim,
              c.base_device.readout.offset_trim);
  }
}

TEST(Draws, WhatAFileWouldRefuseIsAFailureOfTheDevice) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(with_tolerances(
      "\"beam.poisson_ratio\" = { normal = { mean = 0.45, sigma = 0.1 } }\n"));
  int failures = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const VirtualDevice unit = c.device(i);
    ASSERT_EQ(unit.parameters.size(), 1u);
    const bool allowed = unit.parameters[0] <= 0.5;
    EXPECT_EQ(unit.device.has_value(), allowed);
    EXPECT_EQ(unit.failure.empty(), allowed);
    if (allowed) continue;
    ++failures;
    EXPECT_TRUE(holds(unit.failure, "is out of range; expected a number in"));
    EXPECT_FALSE(holds(unit.failure, "\n"));
  }
  EXPECT_GT(failures, 4);  // 31 % of 40
}

// A failure is data: it says the same wherever the files lie.
TEST(Draws, FailuresNameFilesWithoutTheirFolder) {
  const CampaignFolder folder;
  folder.write_rest("[ambient]\nfile = \"hot.csv\"\n");
  folder.write("hot.csv", "time_s,temperature_degC\n0,140\n");
  const CampaignPlan c = folder.campaign(campaign_text(
      "[tolerances]\n\"beam.side_m\" = { discrete = { values = [0.003, 0.0035, "
      "0.0021] } }\n\"patches.width_m\" = { discrete = { values = [0.002, "
      "0.0029] } }\n",
      "", "ambient_offset_K = { uniform = { low = -40, high = 40 } }\n"));
  int devices = 0, runs = 0;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const std::string unit = c.device(i).failure, run = c.run(0, i).failure;
    if (!unit.empty()) ++devices;
    if (!run.empty()) ++runs;
    EXPECT_FALSE(holds(unit, folder.path().string()));
    EXPECT_FALSE(holds(run, folder.path().string()));
    if (!run.empty()) {
      EXPECT_EQ(run,
                "hot.csv:2: temperature_degC 140 is out of range; expected " +
                    run.substr(run.find("a number in")));
    }
  }
  EXPECT_GT(devices, 2);  // one in six
  EXPECT_GT(runs, 6);     // three in eight
}

TEST(Draws, RunsVaryAndShiftTheirAmbient) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(campaign_text(
      "", "",
      "ambient_offset_K = { uniform = { low = -3, high = 3 } }\n[run.vary]\n"
      "\"rate\" = { discrete = { values = [{constant_deg_per_s = 10}, {steps "
      "= [[0, 0], [5, 20]]}] } }\n"
      "\"power.on_s\" = { discrete = { values = [[0], [2.5]], weights = [1, "
      "1] } }\n"));
  ASSERT_EQ(c.runs[0].plan.parameters.size(), 3u);
  std::array<int, 2> rates{}, powers{};
  for (std::uint32_t i = 0; i < 40; ++i) {
    const VirtualRun run = c.run(0, i);
    ASSERT_TRUE(run.scenario) << run.failure;
    const std::size_t rate = static_cast<std::size_t>(run.parameters[0]);
    const std::size_t power = static_cast<std::size_t>(run.parameters[1]);
    ++rates[rate];
    ++powers[power];
    const auto& profile =
        std::get<PiecewiseLinear>(run.scenario->motion[kRateZ]);
    EXPECT_NEAR(profile.value(6) / kDegree, rate == 0 ? 10 : 20, 1e-12);
    EXPECT_EQ(run.scenario->powered[0].on, power == 0 ? 0 : 2.5);
    EXPECT_NEAR(run.scenario->ambient.value(1), 298.15 + run.parameters[2],
                1e-12);
    EXPECT_EQ(run.scenario->duration, 10);
  }
  for (const int count : {rates[0], rates[1], powers[0], powers[1]})
    EXPECT_GT(count, 8);  // of 40 at equal odds: p = 6e-5
}

TEST(Draws, PartsFollowTheirSharesWhateverElseIsDrawn) {
  const CampaignFolder folder;
  const std::string split =
      "[split]\ntrain = 0.7\nvalidation = 0\ntest = 0.3\n";
  const CampaignPlan few = folder.campaign(campaign_text(split));
  const CampaignPlan more = folder.campaign(
      campaign_text(split + "[tolerances]\n" + kOffset, sampling("sobol")));
  std::array<int, 3> counts{};
  constexpr std::uint32_t kDevices = 10000;
  for (std::uint32_t i = 0; i < kDevices; ++i) {
    ++counts[static_cast<std::size_t>(few.part(i))];
    ASSERT_EQ(few.part(i), more.part(i));
  }
  EXPECT_NEAR(counts[0], 7000, 5 * std::sqrt(kDevices * 0.7 * 0.3));
  EXPECT_EQ(counts[1], 0);
}

// Spearman's rank correlation of a Gaussian copula is 6/pi asin(r/2), with a
// standard error of about 1/sqrt(n).
TEST_P(EitherSampling, CorrelatedKeysHaveTheirCorrelationAndMargins) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(with_tolerances(
      std::string(kTransitions) + kOffset +
          "\"beam.side_difference\" = { uniform = { low = -0.0125, high = "
          "-0.0065 } }\n"
          "[[correlated]]\nkeys = [\"bond.glass_transition_degC\", "
          "\"beam.side_difference\", \"mount.glass_transition_degC\"]\n"
          "matrix = [[1, -0.3, 0.6], [-0.3, 1, 0], [0.6, 0, 1]]\n",
      sampling(GetParam())));
  constexpr std::uint32_t kDevices = 4000;
  std::array<std::vector<double>, 4> u;  // mount, bond, side, an offset
  for (std::uint32_t i = 0; i < kDevices; ++i) {
    const std::vector<double> p = c.device(i).parameters;
    u[0].push_back(0.5 * std::erfc(-(p[0] + 48) / 4 / std::sqrt(2)));
    u[1].push_back((p[1] - 30) / 16);
    u[2].push_back((p[6] + 0.0125) / 0.006);
    u[3].push_back(0.5 * std::erfc(-p[2] / 10e-6 / std::sqrt(2)));
  }
  for (const std::vector<double>& margin : u)
    EXPECT_LT(kolmogorov_smirnov(margin), kOnePercent);
  const auto expect_correlation = [&](std::size_t a, std::size_t b, double r) {
    double sum = 0;
    for (std::size_t i = 0; i < kDevices; ++i)
      sum += 12 * (u[a][i] - 0.5) * (u[b][i] - 0.5);
    EXPECT_NEAR(sum / kDevices, 6 / std::numbers::pi * std::asin(r / 2),
                4 / std::sqrt(kDevices))
        << a << ' ' << b;
  };
  expect_correlation(0, 1, 0.6);
  expect_correlation(1, 2, -0.3);
  expect_correlation(0, 2, 0);
  expect_correlation(0, 3, 0);
}

}  // namespace
}  // namespace beamgyro::internal::draws_test
