// SPDX-License-Identifier: MIT
#include "sim/scenario/scenario_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "tests/config/rejection.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::scenario_file_test {
namespace {

constexpr double kZeroCelsius = 273.15;  // [K]

TEST(ScenarioFile, SoaksHoldAndRampInTurn) {
  const ScenarioPlan scenario = scenario_from(
      "",
      "[ambient.soaks]\ntemperatures_degC = [-40, 50, 20]\nhold_s = 600\n"
      "ramp_K_per_min = 2\n");
  const auto celsius = [&](double t) {
    return scenario.ambient.value(t) - kZeroCelsius;
  };
  EXPECT_NEAR(celsius(0), -40, 1e-9);
  EXPECT_NEAR(celsius(600), -40, 1e-9);
  EXPECT_NEAR(celsius(600 + 60), -38, 1e-9);   // up at 2 K/min
  EXPECT_NEAR(celsius(600 + 2700), 50, 1e-9);  // 90 K take 2700 s
  EXPECT_NEAR(celsius(3900), 50, 1e-9);
  EXPECT_NEAR(celsius(3900 + 450), 35, 1e-9);  // down
  EXPECT_NEAR(celsius(3900 + 900), 20, 1e-9);
  EXPECT_NEAR(celsius(1e6), 20, 1e-9);
}

TEST(ScenarioFile, AKeyInPlaceOfThePointsOfAHistoryIsNamed) {
  EXPECT_TRUE(
      holds(rejection([] { scenario_from("[history]\npoint = [[0, 20]]\n"); }),
            "history.points: missing, beside point; expected one of points"));
}

TEST(ScenarioFile, WithoutRateAndPowerItRestsAndIsOnFromTheStart) {
  const ScenarioPlan scenario = scenario_from("");
  EXPECT_EQ(std::get<PiecewiseLinear>(scenario.motion[kRateZ]).value(50), 0);
  ASSERT_EQ(scenario.powered.size(), 1u);
  EXPECT_EQ(scenario.powered[0].on, 0);
  EXPECT_EQ(scenario.powered[0].off, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(scenario.noise_enabled);
  EXPECT_FALSE(scenario.stirred);
  EXPECT_EQ(scenario.age, 0);
}

TEST(ScenarioFile, TheAgeIsInHours) {
  EXPECT_EQ(scenario_from("[age]\nhours = 1000\n").age, 3.6e6);
}

TEST(ScenarioFile, CountsSamplesAsDurationTimesRate) {
  EXPECT_EQ(sample_count(
                scenario_from("", "[ambient]\nconstant_degC=0\n", "0.3", "10")),
            3u);
  EXPECT_EQ(sample_count(scenario_from("", "[ambient]\nconstant_degC=0\n",
                                       "10.99", "0.1")),
            1u);
  EXPECT_EQ(sample_times(scenario_from("")).back(), 99.9);
}

struct BadScenario {
  std::string ambient, extra, message;  // a part of it
};

constexpr const char* kAmbient = "[ambient]\nconstant_degC = 25\n";

TEST(ScenarioFile, WhatIsWrongIsNamedWithItsPlace) {
  const BadScenario scenarios[] = {
      {"[ambient]\n", "", "expected one of"},
      {"[ambient]\nconstant_degC=1\nfile=\"a.csv\"\n", "",
       "expected only one of"},
      {"[ambient]\npoints=[]\n", "", "empty"},
      {"[ambient]\npoints=[[0,1],[0,2]]\n", "", "increasing"},
      {"[ambient]\npoints=[[0,1],[5,999]]\n", "", "out of range"},
      {"[ambient]\nfile=\"no_such.csv\"\n", "", "no_such.csv"},
      {"[ambient.soaks]\ntemperatures_degC=[]\nhold_s=1\nramp_K_per_min=1\n",
       "", "temperatures_degC"},
      {"[ambient.soaks]\ntemperatures_degC=[1]\nhold_s=0\nramp_K_per_min=1\n",
       "", "hold_s"},
      {kAmbient, "[rate]\nsteps=[[5,1],[4,1]]\n", "rate.steps"},
      {kAmbient, "[rate.sine]\namplitude_deg_per_s=1\nfrequency_Hz=0\n",
       "frequency_Hz"},
      {kAmbient, "[rate.random]\nrms_deg_per_s=1\nbandwidth_Hz=1e9\n",
       "bandwidth_Hz"},
      {kAmbient, "[rate]\nconstant_degps=3\n", "expected one of"},
      {kAmbient, "[power]\non_s=[0, 10]\noff_s=[20]\n", "in turn"},
      {kAmbient, "[power]\non_s=[0, 10]\n", "one off"},
      {kAmbient, "[power]\non_s=[5]\noff_s=[2]\n", "in turn"},
      {kAmbient, "[noise]\nenabled=1\n", "noise.enabled"},
      {kAmbient, "[age]\nhours=-1\n", "age.hours"},
      {kAmbient, "[chamber]\nstirred=\"yes\"\n", "chamber.stirred"},
      {kAmbient, "[chamber]\nstired=true\n", "stirred"}};
  for (const BadScenario& bad : scenarios) {
    const std::string message =
        rejection([&] { scenario_from(bad.extra, bad.ambient); });
    EXPECT_TRUE(holds(message, bad.message));
    EXPECT_TRUE(holds(message, "test.toml:"));
  }
}

TEST(ScenarioFile, AnAmbientOffsetShiftsEveryForm) {
  const auto at = [](const std::string& ambient, double t) {
    return scenario_from("", ambient + "offset_K = -10\n").ambient.value(t);
  };
  EXPECT_DOUBLE_EQ(at("[ambient]\nconstant_degC = 25\n", 0), 288.15);
  EXPECT_DOUBLE_EQ(at("[ambient]\npoints = [[0, 20], [10, 30]]\n", 5), 288.15);
  EXPECT_DOUBLE_EQ(at("[ambient]\nsoaks = {temperatures_degC = [40, 20], "
                      "hold_s = 5, ramp_K_per_min = 60}\n",
                      15),
                   293.15);
}

TEST(ScenarioFile, TheShiftedAmbientStaysInRange) {
  EXPECT_THROW(
      scenario_from("", "[ambient]\nconstant_degC = 140\noffset_K = 11\n"),
      std::invalid_argument);
  EXPECT_THROW(
      scenario_from("", "[ambient]\nconstant_degC = 25\noffset_K = 101\n"),
      std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::scenario_file_test
