// SPDX-License-Identifier: MIT
// The sigma of legs of one log that are left out in turn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "compensation/training/train.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::left_out_legs_test {
namespace {

ModelSpec line_of_ramps() {
  return {.inputs = {parse_input("temperature")},
          .rows = {60.0, {}},
          .kind = PolynomialSpec{1}};
}

// Legs between -20 and 40 degC at 3 K/min, each with an offset of its own, as
// a bond that has crept would give it.
std::vector<TrainingRun> legs(int count, std::uint32_t unit) {
  const std::vector<double> offsets = white(10, unit);
  std::vector<TrainingRun> result;
  for (int leg = 0; leg < count; ++leg) {
    RecordedRun one{.duration = 1200.0, .step = 10.0};
    one.temperature = [leg](double t) {
      return leg % 2 == 0 ? -20.0 + 0.05 * t : 40.0 - 0.05 * t;
    };
    one.bias = [=, T = one.temperature](double t) {
      return 0.02 * T(t) + 0.2 * offsets[static_cast<std::size_t>(leg)];
    };
    const std::string name = fmt::format("leg {} of {}", leg, unit);
    result.push_back({name + ".h5", name, one.recording()});
  }
  return result;
}

// The offset of the next leg and the mean of four before: 0.2^2 (1 + 1/4).
TEST(LeftOutLegs, OfACurveIsWhatLegsLeaveThatTheOthersPredict) {
  double squares = 0.0;
  constexpr int kUnits = 60;
  ModelSpec spec = line_of_ramps();
  for (std::uint32_t unit = 0; unit < kUnits; ++unit) {
    const FittedCompensator c =
        train(spec, legs(4, 500 + unit), {}, 1).compensator;
    ASSERT_TRUE(c.sigma);
    EXPECT_EQ(c.sigma->source, SigmaSource::kResiduals);
    EXPECT_EQ(c.sigma->calibration.by, "run");
    EXPECT_EQ(c.sigma->calibration.groups, 4U);
    squares += std::pow(c.sigma->at(10.0, 0.0, 0.05), 2) / kUnits;
  }
  // 3 degrees of freedom each: 0.05 within 2 (2 / 180)^(1/2) = 21 %. Student's
  // t of 24 stretches of 10 K widens by 1.040.
  EXPECT_NEAR(squares / 1.04 / 1.04, 0.05, 0.011);
}

TEST(LeftOutLegs, CrossValidationTellsThatOfATable) {
  ModelSpec spec = line_of_ramps();
  spec.kind = TableSpec{};
  const FittedCompensator c =
      train(spec, legs(4, 3), {}, 1, Grouping::kRun).compensator;
  ASSERT_TRUE(c.sigma);
  EXPECT_EQ(c.sigma->calibration.groups, 4U);
  EXPECT_EQ(c.sigma_not_known, "");
}

// s(T) is then that of ramps, and an absent term would say nothing of them.
TEST(LeftOutLegs, OfRampsAloneSpeaksOfRamps) {
  ModelSpec spec = line_of_ramps();
  for (const auto& [runs, held_out] :
       {std::pair{legs(4, 4), std::vector<TrainingRun>{}},
        std::pair{legs(2, 5), legs(4, 6)}}) {
    const FittedCompensator c = train(spec, runs, held_out, 1).compensator;
    ASSERT_TRUE(c.sigma);
    ASSERT_TRUE(c.sigma->temperature_rate);
    EXPECT_EQ(c.sigma->temperature_rate->amplitude, 0.0);
  }
}

TEST(LeftOutLegs, SaysWhichWayTheTemperaturesWent) {
  ModelSpec spec = line_of_ramps();
  std::vector<TrainingRun> runs = legs(3, 7);
  EXPECT_EQ(train(spec, runs, {}, 1).compensator.sigma->validity.only_way,
            std::nullopt);
  runs.erase(runs.begin() + 1);
  const FittedCompensator c = train(spec, runs, {}, 1).compensator;
  EXPECT_EQ(c.sigma->validity.only_way, TemperatureWay::kRising);
  EXPECT_TRUE(std::ranges::any_of(
      c.provenance.warnings, [](const std::string& warning) {
        return warning.starts_with("sigma is of rising temperatures alone");
      }));
  // A device that is stated to have no memory has no hysteresis.
  for (TrainingRun& run : runs) run.recording.device_text = "[beam]\n";
  EXPECT_EQ(train(spec, runs, {}, 1).compensator.sigma->validity,
            SigmaValidity{});
}

}  // namespace
}  // namespace beamgyro::internal::left_out_legs_test
