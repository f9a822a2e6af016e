// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compensation/compensator/compensator_file.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::bias_sigma_json_test {
namespace {

using Json = nlohmann::ordered_json;

// A good file whose sigma has the patch merged into it.
FittedCompensator parsed_with(const std::string& patch) {
  Json json = Json::parse(compensator_text(with_sigma(spline_compensator())));
  json["sigma"].merge_patch(Json::parse(patch));
  return parse_compensator(json.dump(), "mine.json");
}

std::string error_with(const std::string& patch) {
  return rejection([&] { parsed_with(patch); });
}

TEST(BiasSigmaJson, ReadsWhatItWroteWithTheSameBits) {
  const BiasSigma sigma = *with_sigma(spline_compensator()).sigma;
  const Json json = bias_sigma_json(sigma);
  const BiasSigma read = read_bias_sigma(JsonNode(json, "mine.json"));
  EXPECT_TRUE((read.curve.temperatures == sigma.curve.temperatures).all());
  EXPECT_TRUE((read.curve.values == sigma.curve.values).all());
  EXPECT_EQ(read.growth, sigma.growth);
  EXPECT_EQ(read.power_on, sigma.power_on);
  EXPECT_EQ(read.temperature_rate, sigma.temperature_rate);
  EXPECT_EQ(read.factor, sigma.factor);
  EXPECT_EQ(read.source, sigma.source);
  EXPECT_EQ(read.calibration, sigma.calibration);
  EXPECT_EQ(bias_sigma_json(read).dump(), json.dump());
}

TEST(BiasSigmaJson, AFileWithoutASigmaHasNoMemberOfThatName) {
  const std::string text = compensator_text(spline_compensator());
  EXPECT_FALSE(holds(text, "sigma"));
  EXPECT_FALSE(parse_compensator(text, "mine.json").sigma);
}

TEST(BiasSigmaJson, WhyThereIsNoneIsReadAndNotBesideOne) {
  FittedCompensator c = spline_compensator();
  c.sigma_not_known = "one held-out run";
  const std::string text = compensator_text(c);
  EXPECT_EQ(parse_compensator(text, "mine.json").sigma_not_known,
            "one held-out run");
  Json json = Json::parse(compensator_text(with_sigma(spline_compensator())));
  json["sigma_not_known"] = "why";
  EXPECT_TRUE(
      holds(rejection([&] { parse_compensator(json.dump(), "mine.json"); }),
            "sigma_not_known: is there beside a sigma"));
}

TEST(BiasSigmaJson, WhatItHoldsForIsKept) {
  FittedCompensator c = with_sigma(spline_compensator());
  c.sigma->validity = {TemperatureWay::kFalling, 12.5};
  EXPECT_EQ(parse_compensator(compensator_text(c), "mine.json").sigma->validity,
            c.sigma->validity);
  EXPECT_EQ(parsed_with("{}").sigma->validity, SigmaValidity{});
}

TEST(BiasSigmaJson, TermsMayBeAbsent) {
  EXPECT_NO_THROW(
      parsed_with(R"({"power_on": null, "temperature_rate": null})"));
}

TEST(BiasSigmaJson, FilesOfOlderProgramsHaveNoHalfWidth) {
  EXPECT_NO_THROW(parsed_with(R"({"calibration": {"half_width": null}})"));
}

struct Broken {
  std::string patch, place, words;
};

TEST(BiasSigmaJson, EveryBrokenMemberIsNamed) {
  const std::vector<Broken> all = {
      {R"({"temperature_degC": []})", "temperature_degC", "at least one"},
      {R"({"temperature_degC": null})", "sigma", "is missing"},
      {R"({"temperature_degC": [-40, -10, -10, 50]})", "temperature_degC",
       "must increase"},
      {R"({"temperature_degC": [50, 20, -10, -40]})", "temperature_degC",
       "must increase"},
      {R"({"temperature_degC": [-40, -10, 50]})", "sigma_deg_per_s",
       "4 values for 3 temperatures"},
      {R"({"temperature_degC": [-90, -10, 20, 50]})", "temperature_degC",
       "must lie within"},
      {R"({"temperature_degC": [-40, -10, 20, 500]})", "temperature_degC",
       "must lie within"},
      {R"({"temperature_degC": "warm"})", "temperature_degC", "array"},
      {R"({"sigma_deg_per_s": [0.1, -0.1, 0.1, 0.1]})", "sigma_deg_per_s[1]",
       "above 0"},
      {R"({"sigma_deg_per_s": [0.1, 0.1, 0, 0.1]})", "sigma_deg_per_s[2]",
       "above 0"},
      {R"({"sigma_deg_per_s": [0.1, null, 0.1, 0.1]})", "sigma_deg_per_s[1]",
       "finite number"},
      {R"({"sigma_deg_per_s": []})", "sigma_deg_per_s",
       "0 values for 4 temperatures"},
      {R"({"growth_deg_per_s_per_K": null})", "sigma", "is missing"},
      {R"({"growth_deg_per_s_per_K": [0.1]})", "growth_deg_per_s_per_K",
       "[below, above]"},
      {R"({"growth_deg_per_s_per_K": [0.1, 0]})", "growth_deg_per_s_per_K[1]",
       "above 0"},
      {R"({"power_on": {"sigma_deg_per_s": -1}})", "power_on.sigma_deg_per_s",
       "not be below 0"},
      {R"({"power_on": {"time_constant_s": 0}})", "power_on.time_constant_s",
       "above 0"},
      {R"({"power_on": 3})", "power_on", "an object"},
      {R"({"temperature_rate": {"time_constant_s": null}})", "temperature_rate",
       "is missing"},
      {R"({"temperature_rate": {"tau": 3}})", "temperature_rate", "not known"},
      {R"({"factor": 0})", "factor", "above 0"},
      {R"({"factor": 1e-300})", "factor", "must lie within 1e-12 to 1e+12"},
      {R"({"sigma_deg_per_s": [0.1, 1e-300, 0.1, 0.1]})", "sigma_deg_per_s[1]",
       "must lie within 1e-12 to 1e+12"},
      {R"({"factor": "1"})", "factor", "finite number"},
      {R"({"source": "guess"})", "source", "must be"},
      {R"({"calibration": {"groups": -1}})", "calibration.groups", "integer"},
      {R"({"calibration": {"level": 1}})", "calibration.level", "below 1"},
      {R"({"calibration": {"half_width": -1}})", "calibration.half_width",
       "not be below 0"},
      {R"({"poweron": {}})", "sigma", "\"poweron\" is not known"},
  };
  for (const Broken& one : all) {
    SCOPED_TRACE(one.patch);
    const std::string error = error_with(one.patch);
    EXPECT_TRUE(holds(error, "mine.json: sigma"));
    EXPECT_TRUE(holds(error, one.place));
    EXPECT_TRUE(holds(error, one.words));
    EXPECT_FALSE(holds(error, "\n"));
  }
}

TEST(BiasSigmaJson, ASigmaThatIsNoObjectIsNamed) {
  Json json = Json::parse(compensator_text(with_sigma(spline_compensator())));
  for (const char* value : {"[]", "null", "0.1", "\"small\""}) {
    json["sigma"] = Json::parse(value);
    EXPECT_TRUE(
        holds(rejection([&] { parse_compensator(json.dump(), "mine.json"); }),
              "mine.json: sigma: "))
        << value;
  }
}

}  // namespace
}  // namespace beamgyro::internal::bias_sigma_json_test
