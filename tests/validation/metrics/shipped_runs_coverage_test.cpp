// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/validation/metrics/seeded_runs.h"

namespace beamgyro::internal::shipped_runs_coverage_test {
namespace {

/// Expects that at least so many of the intervals of each metric hold its
/// value without noise, on the runs of the shipped qualification, judged as
/// recorded and after a cubic.
void expect_covered(const std::string& device,
                    const std::vector<std::string>& names, int seeds,
                    int least) {
  SCOPED_TRACE(device);
  const std::filesystem::path scenarios = BEAMGYRO_SCENARIOS;
  std::vector<const Metric*> asked;
  for (const std::string& name : names) asked.push_back(find_metric(name));
  const SeededRuns runs(scenarios / "qualification.toml",
                        scenarios / "devices" / (device + ".toml"),
                        scenarios / "models/cubic.toml", asked, 1);
  std::vector<FoundMetrics> noisy;
  for (int seed = 1; seed <= seeds; ++seed)
    noisy.push_back(runs.noisy(static_cast<std::uint64_t>(seed)));
  const FoundMetrics quiet = runs.quiet(1);
  for (const auto member : {&FoundMetrics::before, &FoundMetrics::after})
    for (std::size_t m = 0; m < names.size(); ++m) {
      const double truth = (quiet.*member)[m]->value;
      const auto covered =
          std::ranges::count_if(noisy, [&](const FoundMetrics& found) {
            const Interval interval = *(found.*member)[m]->interval;
            return interval.low <= truth && truth <= interval.high;
          });
      EXPECT_GE(covered, least)
          << names[m]
          << (member == &FoundMetrics::before ? " before" : " after");
    }
}

const std::vector<std::string> kOfPowerOns = {"power_on_drift_3_min_deg_per_s",
                                              "heading_error_1_min_deg",
                                              "heading_error_10_min_deg"};
const std::vector<std::string> kOfTables = {"scale_factor_error_ppm",
                                            "scale_factor_nonlinearity_ppm",
                                            "scale_factor_asymmetry_ppm"};

// Of 40 intervals of 95 % 33 or fewer hold the truth with a probability of
// 0.003.
TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfMaximaFromPowerOn) {
  expect_covered("nominal", kOfPowerOns, 40, 34);
}

TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfMaximaOfRateTables) {
  expect_covered("nominal", kOfTables, 40, 34);
}

// Its turn-on settles over minutes.
TEST(ManyDrawsOfShippedRuns, HoldTheTruthOfADeviceWhoseTurnOnSettles) {
  expect_covered("lifelike", {"heading_error_10_min_deg"}, 40, 34);
}

const std::vector<std::string> kOthers = {
    "bias_deg_per_s",
    "bias_pp_deg_per_s",
    "bias_sigma_deg_per_s",
    "bias_sensitivity_deg_per_s_per_K",
    "bias_sensitivity_max_deg_per_s_per_K",
    "residual_mean_deg_per_s",
    "residual_sigma_deg_per_s",
    "residual_rms_deg_per_s",
    "residual_max_deg_per_s",
    "residual_pp_deg_per_s",
    "hysteresis_max_deg_per_s",
    "hysteresis_rms_deg_per_s",
    "soak_hysteresis_max_deg_per_s",
    "scale_factor",
    "scale_factor_temperature_sensitivity_ppm_per_K",
    "g_sensitivity_x_deg_per_s_per_g",
    "g_sensitivity_y_deg_per_s_per_g",
    "g_sensitivity_z_deg_per_s_per_g",
    "vibration_rectification_deg_per_s_per_g2",
    "cross_axis_percent"};

// More seeds and every metric that is beneath the noise; test.sh has the
// metrics that once failed.
void expect_all_covered(const std::string& device) {
  std::vector<std::string> all = kOthers;
  for (const auto& more : {kOfPowerOns, kOfTables})
    all.insert(all.end(), more.begin(), more.end());
  expect_covered(device, all, 100, 90);
}

TEST(DeepShippedRuns, HoldTheTruthOfEveryMetricOfNominal) {
  expect_all_covered("nominal");
}

TEST(DeepShippedRuns, HoldTheTruthOfEveryMetricOfLifelike) {
  expect_all_covered("lifelike");
}

}  // namespace
}  // namespace beamgyro::internal::shipped_runs_coverage_test
