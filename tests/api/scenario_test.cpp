// SPDX-License-Identifier: MIT
#include "include/beamgyro/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "include/beamgyro/simulate.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::scenario_api_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

beamgyro::Scenario ten_minutes(const std::vector<std::string>& overrides = {}) {
  return beamgyro::Scenario::read(kScenarios / "ten_minutes.toml", overrides);
}

TEST(PublicScenario, TextsInMemoryGiveTheRunOfTheFiles) {
  const std::vector<std::string> overrides = {"seed=3", "beam.length_m=0.041"};
  const auto read = ten_minutes(overrides);
  const auto device = beamgyro::Device::parse(read.device().text());
  const auto parsed = beamgyro::Scenario::parse(read.text(), device, overrides);
  const Recording first = simulate(read).recording;
  const Recording second = simulate(parsed).recording;
  EXPECT_EQ(column_values(first, "rate"), column_values(second, "rate"));
  EXPECT_EQ(first.overrides_text, "seed=3\nbeam.length_m=0.041\n");
  EXPECT_EQ(first.overrides_text, second.overrides_text);
}

TEST(PublicScenario, ALaterOverrideOfAKeyWins) {
  const auto scenario = ten_minutes({"seed=3"}).with({"seed = 4"});
  EXPECT_EQ(scenario.seed(), 4U);
  EXPECT_EQ(scenario.overrides(), std::vector<std::string>{"seed = 4"});
}

TEST(PublicScenario, ADeviceBringsItsOverrides) {
  const auto scenario = ten_minutes();
  const auto longer = scenario.device().with({"beam.length_m=0.041"});
  const auto changed = scenario.with_device(longer);
  EXPECT_EQ(simulate(changed).recording.overrides_text,
            "beam.length_m=0.041\n");
  EXPECT_NE(column_values(simulate(changed).recording, "drive_frequency"),
            column_values(simulate(scenario).recording, "drive_frequency"));
}

TEST(PublicScenario, ErrorsNameFileLineAndKey) {
  const auto device = ten_minutes().device();
  EXPECT_EQ(rejection([&] {
              beamgyro::Scenario::parse("name = \"x\"\nspeed = 1\n", device, {},
                                        "mine.toml");
            }).substr(0, 10),
            "mine.toml:");
  const std::string unknown =
      rejection([&] { ten_minutes().with({"beam.lenght_m=0.04"}); });
  EXPECT_TRUE(holds(unknown, "beam.length_m"));
  EXPECT_TRUE(
      holds(rejection([&] { ten_minutes().with({"device=\"other.toml\""}); }),
            "expected it as a Device"));
}

TEST(PublicSimulation, ProgressEndsAtOneAndCanCancel) {
  std::vector<double> shares;
  const auto scenario = ten_minutes({"duration_s=20000"});  // of many blocks
  simulate(scenario, {.progress = [&](double share) {
             shares.push_back(share);
             return true;
           }});
  ASSERT_GT(shares.size(), 1U);
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_THROW(simulate(scenario, {.progress = [](double) { return false; }}),
               Cancelled);
}

TEST(PublicSimulation, ACancelledFileIsNotThere) {
  const auto file =
      std::filesystem::temp_directory_path() / "beamgyro_api_test_cancelled.h5";
  EXPECT_THROW(simulate_to_file(ten_minutes(), file,
                                {.progress = [](double) { return false; }}),
               Cancelled);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(PublicDevice, TheCharacteristicHasAValueForEachTemperature) {
  const auto device = ten_minutes().device();
  const std::vector<double> temperatures = {-20, 25, 90};
  const Characteristic found = characterise(device, temperatures);
  ASSERT_EQ(found.columns.size(), 9U);
  for (const CharacteristicColumn& column : found.columns)
    EXPECT_EQ(column.values.size(), 3U) << column.name;
  EXPECT_EQ(found.columns[0].units, "degree/s");
  // 90 degC is beyond the ceramic's, and the drive needs more than 5 V there.
  EXPECT_EQ(found.warnings.size(), 2U);
  const std::vector<double> molten = {200};
  EXPECT_THROW(characterise(device, molten), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::scenario_api_test
