// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/campaign/campaign.h"
#include "tests/config/rejection.h"
#include "tests/sim/campaign/campaign_folder.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::campaign_file_test {
namespace {

constexpr const char* kOffset =
    "\"patches.offset_m\" = { normal = { mean = 0, sigma = 10e-6 } }\n";

TEST(CampaignFile, MinimalCampaignHasTheDefaults) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(campaign_text(""));
  EXPECT_EQ(c.name, "test");
  EXPECT_EQ(c.devices, 100u);
  EXPECT_EQ(c.devices_per_file, 50u);
  EXPECT_EQ(c.source.seed, 3u);
  EXPECT_TRUE(c.output.variables.empty());
  EXPECT_FALSE(c.output.double_precision);
  EXPECT_TRUE(c.output.compress);
  EXPECT_EQ(c.output.truth_rate, 0);
  ASSERT_EQ(c.runs.size(), 1u);
  EXPECT_EQ(c.runs[0].name, "rest");
  EXPECT_TRUE(c.device_plan.parameters.empty());
  EXPECT_TRUE(c.runs[0].plan.parameters.empty());
  EXPECT_EQ(c.part(7), Part::kTrain);
  EXPECT_EQ(c.runs[0].scenario.seed, 3u);
  EXPECT_EQ(c.run(0, 5).scenario->seed, 3u);
  EXPECT_EQ(c.device(5).device->beam.length, 0.04);
}

TEST(CampaignFile, EveryKeyArrives) {
  const CampaignFolder folder;
  const CampaignPlan c = folder.campaign(campaign_text(
      "[split]\ntrain = 0.5\nvalidation = 0.25\ntest = 0.25\n[tolerances]\n" +
          std::string(kOffset) +
          "\"readout.mode\" = { discrete = { values = [\"open_loop\", "
          "\"force_rebalance\"] } }\n"
          "[output]\nvariables = [\"rate\", \"true_bias\"]\n"
          "precision = \"float64\"\ntruth_rate_Hz = 2\ncompress = false\n",
      "description = \"d\"\ndevices_per_file = 7\nsampling = \"sobol\"\n",
      "ambient_offset_K = { uniform = { low = -5, high = 5 } }\n"
      "[run.vary]\n\"ambient.constant_degC\" = { normal = { mean = 20, sigma "
      "= 3 } }\n"));
  EXPECT_EQ(c.devices_per_file, 7u);
  EXPECT_EQ(c.output.variables,
            (std::vector<std::string>{"rate", "true_bias"}));
  EXPECT_TRUE(c.output.double_precision);
  EXPECT_EQ(c.output.truth_rate, 2);
  EXPECT_FALSE(c.output.compress);
  ASSERT_EQ(c.device_plan.parameters.size(), 5u);
  EXPECT_EQ(c.device_plan.parameters[3].name, "patches_offset_m_3");
  EXPECT_EQ(c.device_plan.parameters[3].units, "m");
  EXPECT_EQ(c.device_plan.parameters[3].long_name, "drawn patches.offset_m[3]");
  EXPECT_EQ(c.device_plan.parameters[4].name, "readout_mode_choice");
  EXPECT_EQ(c.device_plan.parameters[4].long_name,
            "drawn readout.mode, index from 0 among: \"open_loop\" | "
            "\"force_rebalance\"");
  ASSERT_EQ(c.runs[0].plan.parameters.size(), 2u);
  EXPECT_EQ(c.runs[0].plan.parameters[0].name, "ambient_constant_degC");
  EXPECT_EQ(c.runs[0].plan.parameters[0].units, "degC");
  EXPECT_EQ(c.runs[0].plan.parameters[1].name, "ambient_offset_K");
}

TEST(CampaignFile, DevicesOfTheCommandReplaceThoseOfTheFile) {
  const CampaignFolder folder;
  folder.campaign(campaign_text(""));
  EXPECT_EQ(CampaignPlan::read(folder.path() / "c.toml", 3).devices, 3u);
  EXPECT_TRUE(
      holds(rejection([&] { CampaignPlan::read(folder.path() / "c.toml", 0); }),
            "devices = 0: out of range"));
}

std::string runs(int count) {
  std::string text;
  for (int k = 1; k < count; ++k)
    text += "[[run]]\nname = \"r" + std::to_string(k) +
            "\"\nscenario = \"rest.toml\"\n";
  return text;
}

TEST(CampaignFile, RunsAreBounded) {
  const CampaignFolder folder;
  EXPECT_EQ(folder.campaign(campaign_text("", "", runs(1000))).runs.size(),
            1000u);
  EXPECT_TRUE(holds(
      rejection([&] { folder.campaign(campaign_text("", "", runs(1001))); }),
      "run: 1001 runs; expected at most 1000"));
}

// A text of 9 MB is read for the run, for the medians of its draws, and then
// for each choice.
TEST(CampaignFile, WhatDrawsHaveReadIsBounded) {
  const CampaignFolder folder;
  std::string blanks;
  blanks.resize(9'000'000, ' ');
  folder.write_rest("[ambient]\nconstant_degC = 25\n#" + blanks + "\n");
  const auto choices = [&](const char* values) {
    return campaign_text("", "",
                         "ambient_offset_K = { discrete = { values = " +
                             std::string(values) + " } }\n");
  };
  EXPECT_EQ(folder.campaign(choices("[1]")).runs.size(), 1u);
  EXPECT_TRUE(holds(rejection([&] { folder.campaign(choices("[1, 2]")); }),
                    "c.toml:7:1: device and scenarios together have more than "
                    "32 MiB"));
}

struct BadCase {
  std::string text, message;  // a part of it
};

// `campaign` makes a campaign of the text of a case.
void expect_rejected(
    const std::vector<BadCase>& cases,
    const std::function<std::string(const std::string&)>& campaign) {
  const CampaignFolder folder;
  for (const BadCase& each : cases) {
    SCOPED_TRACE(each.text);
    const std::string message =
        rejection([&] { folder.campaign(campaign(each.text)); });
    EXPECT_TRUE(holds(message, each.message));
    EXPECT_FALSE(holds(message, "\n"));
  }
}

const std::string kTgPair =
    "\"mount.glass_transition_degC\" = { normal = { mean = -48, sigma = 4 } }\n"
    "\"bond.glass_transition_degC\" = { normal = { mean = 38, sigma = 4 } }\n" +
    std::string(kOffset) + "[[correlated]]\n";
const std::string kBothTg =
    "keys = [\"mount.glass_transition_degC\", "
    "\"bond.glass_transition_degC\"]\n";

TEST(BadCampaign, IsRejectedWithTheKeyAtFault) {
  expect_rejected(
      {{campaign_text("", "devises = 3"),
        "c.toml:5:1: devises: unknown key; did you mean 'devices'?"},
       {"name = \"x\"\ndevice = \"nominal.toml\"\ndevices = 0\n",
        "c.toml:3:11: devices: 0 is out of range"},
       {"name = \"x\"\ndevice = \"nominal.toml\"\ndevices = 1\nseed=1",
        "run: missing; expected at least one [[run]]"},
       {"name = \"x\"\ndevice = \"nothere.toml\"\ndevices = 1\nseed = 1\n",
        "c.toml:2:10: device: there is no file "},
       {campaign_text("", "sampling = \"latin\""),
        "expected one of \"monte_carlo\", \"sobol\""},
       {campaign_text("[split]\ntrain = 0.8\ntest = 0.1\n"),
        "split: the shares sum to 0.9; expected 1"},
       {campaign_text("[trims]\nquadrature = 1\n"), "expected true or false"},
       {campaign_text("[output]\ntruth_rate_Hz = 3\n"),
        "3 does not divide the output rate 10 Hz of the run rest"},
       {campaign_text("[output]\ntruth_rate_Hz = 20\n"), "does not divide"},
       {campaign_text("[output]\ntruth_rate_Hz = 1e-300\n"),
        "1e-300 does not divide the output rate 10 Hz of the run rest; "
        "expected a rate that does, 1e+08 times slower at most"},
       {campaign_text("[output]\nprecision = \"double\"\n"),
        "output.precision"},
       {with_tolerances(kTgPair +
                        "keys = [\"mount.glass_transition_degC\", "
                        "\"bond.glass_transition_deg\"]\ncorrelation = 0.5\n"),
        "did you mean 'bond.glass_transition_degC'?"},
       {with_tolerances(kTgPair + "keys = [\"mount.glass_transition_degC\", "
                                  "\"patches.offset_m\"]\ncorrelation = 0.5\n"),
        "is an array; expected keys of one number"},
       {with_tolerances(
            kTgPair +
            "keys = [\"mount.glass_transition_degC\"]\ncorrelation = 0.5\n"),
        "two tolerances or more"},
       {with_tolerances(kTgPair + kBothTg + "matrix = [[1, 1], [1, 1]]\n"),
        "c.toml:12:10: correlated[0].matrix: not positive definite"},
       {with_tolerances(kTgPair + kBothTg + "matrix = [[1, 0.1], [0.2, 1]]\n"),
        "not symmetric"},
       {with_tolerances(kTgPair + kBothTg + "correlation = 0.5\n" +
                        "[[correlated]]\n" + kBothTg + "correlation = 0.5\n"),
        "is correlated already"},
       {with_tolerances(kTgPair + kBothTg +
                        "corelation = 0.5\ncorrelation = 0.5\n"),
        "did you mean 'correlation'?"},
       {campaign_text("[trims]\nquadrature = false\n[tolerances]\n"
                      "\"readout.quadrature_trim_deg_per_s\" = { normal = { "
                      "mean = 0, sigma = 50 } }\n"),
        "trims.quadrature = false; remove one"},
       {campaign_text("[trims]\nscale_factor = false\n[tolerances]\n"
                      "\"readout.mode\" = { discrete = { values = "
                      "[\"open_loop\", \"force_rebalance\"] } }\n"),
        "the modes have no common scale factor"},
       {with_tolerances("\"beam.side_m\" = { uniform = { low = 1e-3, high = "
                        "3.1e-3 } }\n\"patches.width_m\" = { uniform = { low = "
                        "1.9e-3, high = 2.7e-3 } }\n"),
        "patches.width_m: "}},
      std::identity());
}

TEST(BadCampaign, HasToleranceThatIsNone) {
  expect_rejected(
      {{"\"mount.axis_angel_deg\" = { uniform = { low = 0, high = 1 } }",
        "c.toml:7:26: mount.axis_angel_deg: "},
       {"\"mount.axis_angel_deg\" = { uniform = { low = 0, high = 1 } }",
        "did you mean 'mount.axis_angle_deg'?"},
       {"\"beam.axis_angle_deg\" = { uniform = { low = 0, high = 1 } }",
        "did you mean 'mount.axis_angle_deg'?"},
       {"mount.axis_angle_deg = { uniform = { low = 0, high = 1 } }",
        "a dotted key in quotes"},
       {"\"beam.length_m\" = { normal = { mean = -1, sigma = 1 } }",
        "c.toml:7:19: beam.length_m: -1 is out of range"},
       {"\"readout.adc_bits\" = { discrete = { values = [14, 40] } }",
        "readout.adc_bits: 40 is out of range"},
       {"\"readout.adc_bits\" = { uniform = { low = 12, high = 16 } }",
        "expected an integer"},
       {"\"beam\" = { uniform = { low = 0, high = 1 } }", "expected a table"}},
      [](const std::string& line) { return with_tolerances(line + "\n"); });
}

TEST(BadCampaign, HasDistributionThatIsNone) {
  expect_rejected(
      {{"3", "expected a table"},
       {"{}", "no distribution"},
       {"{ gauss = { mean = 0, sigma = 1 } }",
        "no distribution; expected one of"},
       {"{ normal = { mean = 0, sigma = 1 }, uniform = { low = 0, high = 1 } }",
        "no distribution; expected one of"},
       {"{ normal = { mean = 0, sigma = 1, mode = 2 } }", "mode: unknown key"},
       {"{ normal = { mean = 0 } }", "sigma: missing; expected a number > 0"},
       {"{ normal = { mean = 0, sigma = 0 } }", "sigma: 0 is out of range"},
       {"{ uniform = { low = 1, high = 0 } }", "0 is not above low = 1"},
       {"{ normal = { mean = 0, sigma = 1, low = 9, high = 10 } }",
        "less than a millionth"},
       {"{ lognormal = { median = -1, sigma = 1 } }",
        "median: -1 is out of range"},
       {"{ discrete = { values = [] } }", "at least one value"},
       {"{ discrete = { values = [1, 2], weights = [1] } }",
        "expected an array of 2 numbers"},
       {"{ discrete = { values = [1, 2], weights = [2, -1] } }",
        "-1 is out of range"},
       {"{ discrete = { values = [1, \"x\"] } }",
        "\"x\" is wrong here; expected a number"}},
      [](const std::string& distribution) {
        return with_tolerances("\"mount.axis_angle_deg\" = " + distribution +
                               "\n");
      });
}

TEST(BadCampaign, HasRunThatIsNone) {
  const auto vary = [](const std::string& key, const std::string& values) {
    return "[run.vary]\n\"" + key + "\" = { discrete = { values = [" + values +
           "] } }\n";
  };
  expect_rejected(
      {{"[[run]]\nname = \"Rest\"\nscenario = \"rest.toml\"",
        "\"Rest\" is no name of files"},
       {"[[run]]\nname = \"rest\"\nscenario = \"rest.toml\"",
        "is the name of an earlier run"},
       {"[[run]]\nname = \"other\"\n", "run[1].scenario: missing"},
       {"speed = 3\n", "run[0].speed: unknown key"},
       {vary("duration_s", "10, 20"), "the same for all devices"},
       {vary("output_rate_Hz", "10, 20"), "the same for all devices"},
       {vary("seed", "1, 2"), "the same for all devices"},
       {vary("fidelity", "\"quasistatic\""), "the same for all devices"},
       {vary("device", "\"nominal.toml\""), "the same for all devices"},
       {vary("noise.enabled", "true, false"), "the same for all devices"},
       {vary("ambient.constant_deg", "20"),
        "did you mean 'ambient.constant_degC'?"},
       {vary("ambient.points", "[[0, 20]]"), "only one of"},
       {vary("ambient.constant_degC", "20, 400"),
        "ambient.constant_degC: 400 is out of range"},
       {"ambient_offset_K = { normal = { mean = 300, sigma = 1 } }\n",
        "ambient.offset_K: 300 is out of range"},
       {"ambient_offset_K = { normal = { mean = 0, sigma = 1 } }\n" +
            vary("ambient.offset_K", "1"),
        "is drawn already"},
       {vary("ambient", "{constant_degC = 20}") +
            "\"ambient.constant_degC\" = { discrete = { values = [1] } }\n",
        "no key inside another"},
       {vary("ambient", "{constant_degC = 20}, {file = \"no.csv\"}"),
        "is no file; expected a CSV file"}},
      [](const std::string& run) { return campaign_text("", "", run); });
}

TEST(CampaignFile, TheBaseFilesAreCheckedAsAnyOther) {
  const CampaignFolder folder;
  folder.write_rest("speed = 1\n[ambient]\nconstant_degC = 25\n");
  EXPECT_TRUE(holds(rejection([&] { folder.campaign(campaign_text("")); }),
                    "rest.toml:7:1: speed: unknown key"));
}

// Every file a device could read is among the sources, and copies of them in
// the same places make the same campaign, whatever became of the originals.
TEST(CampaignFile, CopiesOfTheSourcesMakeTheSameCampaign) {
  const CampaignFolder folder;
  std::filesystem::create_directories(folder.path() / "profiles");
  for (const char* name : {"a", "b", "c"}) {
    folder.write(std::string("profiles/") + name + ".csv",
                 std::string("time_s,temperature_degC,rate_deg_per_s\n0,1") +
                     std::to_string(name[0] % 10) + ".5,1\n5,20,2\n");
  }
  folder.write_rest("[ambient]\nfile = \"profiles/a.csv\"\n");
  const std::string text = campaign_text(
      "[tolerances]\n" + std::string(kOffset), "",
      "[run.vary]\n\"ambient.file\" = { discrete = { values = "
      "[\"profiles/a.csv\", \"profiles/b.csv\"] } }\n"
      "\"rate\" = { discrete = { values = [{constant_deg_per_s = 1}, {file = "
      "\"profiles/c.csv\"}] } }\n");
  const CampaignPlan original = folder.campaign(text);
  ASSERT_EQ(original.sources.size(), 6u);
  EXPECT_EQ(original.sources[0].text, text);

  const CampaignFolder copy;
  std::filesystem::create_directories(copy.path() / "profiles");
  std::filesystem::remove(copy.path() / "nominal.toml");
  std::filesystem::remove(copy.path() / "rest.toml");
  for (const SourceText& source : original.sources) {
    copy.write(source.path.lexically_relative(folder.path()).string(),
               source.text);
  }
  for (const char* name : {"a", "b", "c"})
    std::filesystem::remove(folder.path() / "profiles" /
                            (std::string(name) + ".csv"));
  const CampaignPlan again = CampaignPlan::read(copy.path() / "c.toml");
  bool differ = false;
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_EQ(original.device(i).overrides, again.device(i).overrides);
    const VirtualRun a = original.run(0, i), b = again.run(0, i);
    EXPECT_EQ(a.overrides, b.overrides);
    ASSERT_TRUE(a.scenario && b.scenario) << a.failure << b.failure;
    EXPECT_EQ(a.scenario->ambient.value(1), b.scenario->ambient.value(1));
    differ |= a.scenario->ambient.value(1) !=
              original.run(0, 0).scenario->ambient.value(1);
  }
  EXPECT_TRUE(differ);
}

TEST(CampaignFile, TheShippedCampaignsCanBeRead) {
  for (const char* name : {"small", "paper", "warm_up", "large", "lifelike",
                           "lifelike_population", "population"}) {
    const CampaignPlan c = CampaignPlan::read(std::string(BEAMGYRO_SCENARIOS) +
                                              "/campaigns/" + name + ".toml");
    EXPECT_EQ(c.name, name);
    for (std::uint32_t i = 0; i < 20; ++i) {
      EXPECT_EQ(c.device(i).failure, "");
      for (std::size_t r = 0; r < c.runs.size(); ++r)
        EXPECT_EQ(c.run(r, i).failure, "");
    }
  }
}

}  // namespace
}  // namespace beamgyro::internal::campaign_file_test
