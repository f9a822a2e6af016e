// SPDX-License-Identifier: MIT
#include "config/overrides.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "config/config_node.h"
#include "config/document.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::overrides_test {
namespace {

constexpr const char* kScenario =
    "device = \"unit.toml\"\nduration_s = 60\n[noise]\nenabled = true\n";
constexpr const char* kDevice =
    "[beam]\nlength_m = 0.04\n[readout]\nmode = \"open_loop\"\n[noise]\n"
    "turn_on_deg_per_s = 0.1\n";

struct Values {
  double duration = 0.0, length = 0.0, angular_gain = 0.0, turn_on = 0.0;
  bool noise = false;
  std::string mode;
  std::vector<double> points;
};

/// Reads both documents of one command, as the program does.
Values read_both(Overrides& overrides) {
  Values values;
  const ConfigDocument scenario =
      ConfigDocument::parse(kScenario, "scn.toml", overrides);
  scenario.root().text("device");
  values.duration = scenario.root().number("duration_s", positive());
  const ConfigTable noise = scenario.root().table_or_empty("noise");
  values.noise = noise.flag_or("enabled", true);
  if (const auto rate = scenario.root().optional_table("rate"))
    values.points = rate->numbers("points");
  scenario.reject_unknown_keys();

  const ConfigDocument device =
      ConfigDocument::parse(kDevice, "unit.toml", overrides);
  const ConfigTable beam = device.root().table("beam");
  values.length = beam.number("length_m", positive());
  values.angular_gain = beam.number_or("angular_gain", -1.0);
  values.mode = device.root().table("readout").choice(
      "mode", {"open_loop", "force_rebalance"});
  values.turn_on = device.root().table("noise").number("turn_on_deg_per_s");
  device.reject_unknown_keys();
  overrides.check_all_used();
  return values;
}

Values read_with(const std::vector<std::string>& arguments) {
  Overrides overrides(arguments);
  return read_both(overrides);
}

std::string rejection_of(const std::vector<std::string>& arguments) {
  return rejection([&] { read_with(arguments); });
}

TEST(Overrides, NoneLeaveTheFilesAsTheyAre) {
  const Values values = read_with({});
  EXPECT_EQ(values.duration, 60.0);
  EXPECT_EQ(values.length, 0.04);
  EXPECT_TRUE(values.noise);
}

TEST(Overrides, ReplaceKeysOfTheScenarioAndOfTheDevice) {
  const Values values = read_with(
      {"duration_s=5", "beam.length_m=0.038", "noise.enabled=false",
       "noise.turn_on_deg_per_s=0", "readout.mode=\"force_rebalance\""});
  EXPECT_EQ(values.duration, 5.0);
  EXPECT_EQ(values.length, 0.038);
  EXPECT_FALSE(values.noise);
  EXPECT_EQ(values.turn_on, 0.0);
  EXPECT_EQ(values.mode, "force_rebalance");
}

TEST(Overrides, CreateKeysAndTablesTheFileLacks) {
  EXPECT_EQ(read_with({"beam.angular_gain=1"}).angular_gain, 1.0);
  EXPECT_EQ(read_with({"rate.points=[1, 2.5]"}).points,
            (std::vector<double>{1.0, 2.5}));
}

TEST(Overrides, ReplaceWholeTables) {
  EXPECT_EQ(read_with({"rate={points=[3]}"}).points, std::vector<double>{3.0});
  EXPECT_EQ(read_with({"beam={length_m=0.05}", "beam.angular_gain=0.5"}).length,
            0.05);
}

TEST(Overrides, PassTheSameChecksAndNameThemselvesAsThePlace) {
  const std::pair<std::string, std::string> arguments[] = {
      {"beam.length_m=-1",
       "beam.length_m: -1 is out of range; expected a number > 0"},
      {"duration_s=nan",
       "duration_s: nan is not finite; expected a number > 0"},
      {"duration_s=\"long\"",
       "duration_s: \"long\" is wrong here; expected a number > 0"},
      {"rate.points=[1, true]",
       "rate.points[1]: true is wrong here; expected a finite number"},
      {"beam.lenght_m=1",
       "no file of this command has a key 'beam.lenght_m'; did you mean "
       "'beam.length_m'?"},
      {"length_m=1",
       "no file of this command has a key 'length_m'; did you mean "
       "'beam.length_m'?"},
      {"zzz.yyy=1",
       "no file of this command has a key 'zzz.yyy'; expected a key of the "
       "scenario or the device"},
      {"rate={points=[3], pionts=[4]}",
       "rate.pionts: unknown key; did you mean 'points'?"},
      {"readout.mode=open_loop",
       "'open_loop' is not TOML; a text needs quotes: "
       "readout.mode=\"open_loop\""},
      {"noise.enabled=True", "'True' is not TOML; write noise.enabled=true"},
      {"beam.length_m",
       "no '=' in it; expected KEY=VALUE such as beam.length_m=0.038"},
      {"=1", "the key before '=' is missing"},
      {"beam..x=1", "the key 'beam..x' has an empty part beside a dot"},
      {"be am.x=1",
       "'be am.x' is not a key; expected letters, digits, '_' and '-' joined "
       "by dots, such as beam.length_m"},
      {"beam.x=", "no value after '='; expected one in TOML syntax"}};
  for (const auto& [argument, message] : arguments)
    EXPECT_EQ(rejection_of({argument}),
              fmt::format("set {}: {}", argument, message));
}

TEST(Overrides, OfMoreThanOneValueAreRejected) {
  EXPECT_TRUE(rejection_of({"beam.x=[1, 2"})
                  .starts_with("set beam.x=[1, 2: '[1, 2' is not TOML"));
  EXPECT_TRUE(rejection_of({"beam.x=1 2"})
                  .starts_with("set beam.x=1 2: '1 2' is not TOML"));
  EXPECT_TRUE(rejection_of({"a=1\nb=2"})
                  .starts_with("set a=1\\x0ab=2: an override is one line"));
}

TEST(Overrides, APathThroughAValueIsRejected) {
  EXPECT_EQ(rejection_of({"duration_s.x=1"}),
            "set duration_s.x=1: 'duration_s' is 60 in scn.toml, not a table");
  EXPECT_EQ(rejection_of({"rate=1", "rate.points=[1]"}),
            "set rate.points=[1]: 'rate' is 1 in an earlier one, not a "
            "table");
}

TEST(Overrides, TheSameKeyTwiceIsRejected) {
  EXPECT_EQ(rejection_of({"duration_s=1", "duration_s=1"}),
            "set duration_s=1: the key was set before, by "
            "duration_s=1");
  EXPECT_EQ(rejection_of({"beam.length_m=1", "beam={length_m=2}"}),
            "set beam={length_m=2}: would replace the earlier "
            "beam.length_m=1; give the whole table first");
}

TEST(Overrides, TextHoldsOneArgumentPerLineInTheOrderGiven) {
  EXPECT_EQ(Overrides({"b.x=1", "a=\"q\""}).text(), "b.x=1\na=\"q\"\n");
  EXPECT_EQ(Overrides().text(), "");
}

// A value added as a node reads as its text on the command line does.
TEST(Overrides, AddedValuesReadBackFromTheirText) {
  const ConfigDocument values = ConfigDocument::parse(
      "a = [0.1, 1e300, -5.0, 1e-5, 3]\nb = \"q\\\"\\\\\\t\"\nc = {d = true, "
      "\"e f\" = [[1, 2]]}\n",
      "values.toml");
  Overrides added;
  for (const char* key : {"a", "b", "c"})
    added.add({key}, values.root().value(key));
  EXPECT_EQ(
      added.text(),
      "a=[0.1, 1e+300, -5.0, 1e-05, 3]\nb=\"q\\\"\\\\\\u0009\"\nc={\"d\" = "
      "true, \"e f\" = [[1, 2]]}\n");
  Overrides typed({"a=[0.1, 1e+300, -5.0, 1e-05, 3]", "b=\"q\\\"\\\\\\u0009\"",
                   "c={\"d\" = true, \"e f\" = [[1, 2]]}"});
  for (Overrides* set : {&added, &typed}) {
    const ConfigDocument document = ConfigDocument::parse("", "x.toml", *set);
    const ConfigTable& root = document.root();
    EXPECT_EQ(root.numbers("a"),
              (std::vector<double>{0.1, 1e300, -5, 1e-5, 3}));
    EXPECT_EQ(root.text("b"), "q\"\\\t");
    EXPECT_TRUE(root.table("c").flag("d"));
    EXPECT_EQ(root.table("c").rows("e f", 2)[0][1], 2);
  }
}

TEST(Overrides, AnAddedValueIsBlamedAtItsPlace) {
  Overrides set;
  set.add({"beam", "x"}, number_node(-1), "c.toml:3:4");
  const ConfigDocument document = ConfigDocument::parse("", "x.toml", set);
  EXPECT_EQ(
      rejection([&] { document.root().table("beam").number("x", positive()); }),
      "c.toml:3:4: beam.x: -1 is out of range; expected a number > 0");
  EXPECT_TRUE(set.all_used());
  EXPECT_EQ(set.known_keys(), (std::vector<std::string>{"beam", "beam.x"}));
}

}  // namespace
}  // namespace beamgyro::internal::overrides_test
