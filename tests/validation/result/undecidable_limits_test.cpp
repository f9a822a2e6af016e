// SPDX-License-Identifier: MIT
#include "validation/result/undecidable_limits.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/scenario/simulation_input.h"
#include "validation/qualification/qualification_file.h"

namespace beamgyro::internal::undecidable_limits_test {
namespace {

/// What is said of the limits on the shipped qualification and device.
std::vector<std::string> said_of(const std::string& limits) {
  static const Qualification kQualification = read_qualification(
      std::string(BEAMGYRO_SCENARIOS) + "/qualification.toml");
  const LoadedDevice loaded = load_device(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml", {});
  return undecidable_limits(
      kQualification, {loaded.device, loaded.text},
      parse_specification_file("name = \"own\"\n[limits]\n" + limits, "own"),
      1);
}

std::string at_most(const std::string& metric, double most) {
  return fmt::format("{} = {{ max = {}, source = \"a test\" }}\n", metric,
                     most);
}

void expect_words(const std::string& said,
                  const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(said.find(word), std::string::npos) << word << "\n" << said;
}

// 20 s of each rate leave 100 ppm of noise in the largest of 55 means.
TEST(UndecidableLimits, ANonlinearityBelowTheNoiseOfTheTables) {
  const auto said = said_of(at_most("scale_factor_nonlinearity_ppm", 100) +
                            at_most("scale_factor_error_ppm", 1000));
  ASSERT_EQ(said.size(), 1u);
  expect_words(said[0],
               {"scale_factor_nonlinearity_ppm, at most 100", "noise alone"});
}

// The white noise of an hour hides 43 deg/h/sqrt(h), that of a day does not.
TEST(UndecidableLimits, ARandomWalkThatAnHourDoesNotShow) {
  const auto said =
      said_of(at_most("rate_random_walk_deg_per_h_per_sqrt_h", 200) +
              at_most("angle_random_walk_deg_per_sqrt_h", 1));
  ASSERT_EQ(said.size(), 1u);
  expect_words(said[0], {"rate_random_walk", "does not show it",
                         "times as long", "in place of 1 h"});
}

TEST(UndecidableLimits, AResidualBelowTheTurnOnOffset) {
  const auto said = said_of(at_most("residual_rms_deg_per_s", 0.003));
  ASSERT_EQ(said.size(), 1u);
  expect_words(said[0], {"residual_rms_deg_per_s",
                         "longer runs of this kind would not"});
  EXPECT_TRUE(said_of(at_most("residual_rms_deg_per_s", 0.1)).empty());
}

TEST(UndecidableLimits, WhatTheNoiseDoesNotDecideIsLeftOut) {
  EXPECT_TRUE(said_of(at_most("bandwidth_Hz", 100) +
                      at_most("sigma_pit_distance_soaks", 0.1) +
                      "[limits_relative_to.cubic]\n" +
                      at_most("residual_sigma_deg_per_s", 0.01))
                  .empty());
}

TEST(UndecidableLimits, AMetricThatNoRunShows) {
  Qualification few = read_qualification(std::string(BEAMGYRO_SCENARIOS) +
                                         "/qualification.toml");
  std::erase_if(few.runs, [](const QualificationRun& run) {
    return run.purpose == RunPurpose::kTumble;
  });
  const LoadedDevice loaded = load_device(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/nominal.toml", {});
  const auto said = undecidable_limits(
      few, {loaded.device, loaded.text},
      parse_specification_file(
          "name = \"own\"\n[limits]\n" +
              at_most("g_sensitivity_x_deg_per_s_per_g", 0.1),
          "own"),
      1);
  ASSERT_EQ(said.size(), 1u);
  expect_words(said[0], {"no run shows it", "tumble"});
}

}  // namespace
}  // namespace beamgyro::internal::undecidable_limits_test
