// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_validity.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::sigma_validity_test {
namespace {

using Reasons = std::vector<std::string>;

constexpr const char* kMemory = "[memory.ageing]\n";

Recording run_from(double first, double last) {
  RecordedRun run;
  run.temperature = [=](double t) {
    return first + (last - first) * t / run.duration;
  };
  return run.recording();
}

Recording aged(double hours) {
  Recording recording = run_from(20.0, 40.0);
  recording.device_text = kMemory;
  recording.scenario_text = "[age]\nhours = " + std::to_string(hours) + "\n";
  return recording;
}

TEST(SigmaValidity, GyrosWithoutAStatedDeviceOrWithMemoryMayRemember) {
  Recording recording;
  EXPECT_TRUE(may_remember(recording));
  recording.device_text = "[beam]\nlength_m = 0.04\n";
  EXPECT_FALSE(may_remember(recording));
  recording.overrides_text = "memory.hysteresis.half_width_K=2\n";
  EXPECT_TRUE(may_remember(recording));
}

TEST(SigmaValidity, UnitsThatAgeSayItInTheirFilesOrOverrides) {
  Recording recording;
  EXPECT_EQ(stated_age(recording), std::nullopt);
  recording.device_text = "[beam]\nlength_m = 0.04\n";
  recording.scenario_text = "name = \"rest\"\n";
  EXPECT_EQ(stated_age(recording), std::nullopt);
  recording.device_text += kMemory;
  EXPECT_EQ(stated_age(recording), 0.0);
  recording.device_text = "";
  EXPECT_EQ(stated_age(recording), std::nullopt);
  recording.scenario_text += "[age]\nhours = 8766\n";
  EXPECT_EQ(stated_age(recording), 8766.0);
  recording.scenario_text = "name = \"rest\"\n";
  recording.overrides_text = "age.hours=24.5\n";
  EXPECT_EQ(stated_age(recording), 24.5);
}

TEST(SigmaValidity, OfOneWayDoesNotHoldTheOtherWay) {
  const SigmaValidity rising{TemperatureWay::kRising, {}};
  EXPECT_EQ(reasons_against_sigma(rising, run_from(-20.0, 40.0)), Reasons{});
  EXPECT_EQ(reasons_against_sigma(rising, run_from(40.0, 31.0)), Reasons{});
  const Reasons found = reasons_against_sigma(rising, run_from(40.0, -20.0));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].find("sigma does not hold of falling temperatures"), 0U);
  const SigmaValidity falling{TemperatureWay::kFalling, {}};
  EXPECT_EQ(reasons_against_sigma(falling, run_from(-20.0, 40.0)).size(), 1U);
  EXPECT_EQ(reasons_against_sigma({}, run_from(40.0, -20.0)), Reasons{});
}

TEST(SigmaValidity, OfUnitsThatAgeIsForAWeek) {
  const SigmaValidity young{{}, 10.0};
  EXPECT_EQ(reasons_against_sigma(young, aged(178.0)), Reasons{});
  EXPECT_EQ(reasons_against_sigma(young, aged(179.0)).size(), 1U);
  EXPECT_EQ(reasons_against_sigma({}, aged(8766.0)), Reasons{});
  Recording unstated = aged(8766.0);
  unstated.device_text = unstated.scenario_text = "";
  EXPECT_EQ(reasons_against_sigma(young, unstated), Reasons{});
}

TEST(SigmaValidity, ReadsWhatItWrote) {
  for (const SigmaValidity& one :
       {SigmaValidity{TemperatureWay::kFalling, 8.5},
        SigmaValidity{TemperatureWay::kRising, {}}, SigmaValidity{{}, 0.0}}) {
    const nlohmann::ordered_json json = sigma_validity_json(one);
    EXPECT_EQ(read_sigma_validity(JsonNode(json, "c.json")), one);
  }
  EXPECT_TRUE(sigma_validity_json({}).is_null());
}

TEST(SigmaValidity, RefusesWhatIsNoneByName) {
  const auto error = [](const std::string& text) {
    return rejection([&] {
      const auto json = nlohmann::ordered_json::parse(text);
      read_sigma_validity(JsonNode(json, "c.json"));
    });
  };
  EXPECT_TRUE(holds(error(R"({"temperature_way": "up"})"),
                    "\"up\", must be \"rising\" or \"falling\""));
  EXPECT_TRUE(holds(error(R"({"age_hours": -1})"), "must not be below 0"));
  EXPECT_TRUE(holds(error(R"({"until": 3})"), "not known"));
}

}  // namespace
}  // namespace beamgyro::internal::sigma_validity_test
