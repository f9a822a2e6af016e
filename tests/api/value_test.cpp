// SPDX-License-Identifier: MIT
#include "include/beamgyro/value.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "include/beamgyro/campaign.h"
#include "include/beamgyro/compensator.h"
#include "include/beamgyro/scenario.h"
#include "include/beamgyro/set.h"
#include "include/beamgyro/train.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::value_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

beamgyro::Scenario ten_minutes() {
  return beamgyro::Scenario::read(kScenarios / "ten_minutes.toml");
}

TEST(Value, HasTheTextThatTheKeyWouldHave) {
  EXPECT_EQ(Value(true).toml(), "true");
  EXPECT_EQ(Value(60).toml(), "60");
  EXPECT_EQ(Value(60.0).toml(), "60.0");
  EXPECT_EQ(Value(0.1).toml(), "0.1");
  EXPECT_EQ(Value(std::numeric_limits<std::uint64_t>::max()).toml(),
            "18446744073709551615");
  EXPECT_EQ(Value("a \"b\"\n").toml(), R"("a \"b\"\u000a")");
  EXPECT_EQ(Value(std::string("envelope")).toml(), "\"envelope\"");
  EXPECT_EQ(Value(std::vector{1.5, 2.0}).toml(), "[1.5, 2.0]");
  EXPECT_EQ(Value(std::vector<std::string>{}).toml(), "[]");
  EXPECT_EQ(Value({{0.0, 25.0}, {60.0, 30.0}}).toml(),
            "[[0.0, 25.0], [60.0, 30.0]]");
}

TEST(Value, OfAKeyIsThatOfItsText) {
  const auto typed = ten_minutes()
                         .with("duration_s", 60.0)
                         .with("fidelity", "envelope")
                         .with("noise.enabled", false)
                         .with({override_of("power.on_s", {0.0, 30.0}),
                                override_of("power.off_s", std::vector{20.0})})
                         .with("seed", 4U)
                         .with("beam.length_m", 0.0401);
  const auto of_text = ten_minutes().with(
      {"duration_s=60.0", "fidelity=\"envelope\"", "noise.enabled=false",
       "power.on_s=[0.0, 30.0]", "power.off_s=[20.0]", "seed=4",
       "beam.length_m=0.0401"});
  EXPECT_EQ(typed.overrides(), of_text.overrides());
  EXPECT_EQ(typed.duration(), 60.0);
  EXPECT_EQ(typed.fidelity(), "envelope");
  EXPECT_EQ(ten_minutes().device().with("beam.length_m", 0.0401).overrides(),
            std::vector{override_of("beam.length_m", 0.0401)});
}

TEST(Value, WhatIsWrongSaysKeyValueAndWhatIsRight) {
  const auto of = [](const char* key, const Value& value) {
    return rejection([&] { ten_minutes().with(key, value); });
  };
  const std::string negative = of("duration_s", -1.0);
  EXPECT_TRUE(holds(negative, "set duration_s=-1.0: duration_s:")) << negative;
  EXPECT_TRUE(holds(negative, "expected")) << negative;
  for (const auto& [key, value] :
       {std::pair<const char*, Value>{"duration_s", "long"},
        {"duration_s", true},
        {"duration_s", {1.0, 2.0}},
        {"duration_s", std::numeric_limits<double>::quiet_NaN()},
        {"seed", 1.5},
        {"seed", std::numeric_limits<std::uint64_t>::max()},
        {"fidelity", "fast"},
        {"noise.enabled", 1},
        {"power.on_s", 3.0}}) {
    const std::string words = of(key, value);
    EXPECT_TRUE(holds(words, override_of(key, value))) << words;
    EXPECT_TRUE(holds(words, "expected") || holds(words, "must be")) << words;
  }
  EXPECT_TRUE(holds(of("duration", 60.0), "duration_s"));
  for (const char* key : {"", "seed=3, x", "a b", "beam..length_m", "a#"})
    EXPECT_TRUE(holds(of(key, 1.0), "key")) << key;
}

template <class Type, class Content>
constexpr bool is_never_empty =
    !std::is_default_constructible_v<Type> &&
    !std::is_constructible_v<Type, std::nullptr_t> &&
    !std::is_constructible_v<Type, std::shared_ptr<const Content>> &&
    !std::is_constructible_v<Type, std::shared_ptr<Content>> &&
    std::is_copy_assignable_v<Type>;
static_assert(is_never_empty<Device, DeviceState>);
static_assert(is_never_empty<Scenario, ScenarioState>);
static_assert(is_never_empty<Campaign, CampaignPlan>);
static_assert(is_never_empty<Compensator, CompensatorState>);
static_assert(is_never_empty<Model, ModelSpec>);
static_assert(is_never_empty<Set, OpenSet>);

TEST(SharedContent, StaysWhereADeviceWasMovedFrom) {
  auto device = ten_minutes().device();
  const auto other = std::move(device);
  // NOLINTNEXTLINE(bugprone-use-after-move): what the test is about.
  EXPECT_EQ(device.text(), other.text());
}

}  // namespace
}  // namespace beamgyro::internal::value_test
