// SPDX-License-Identifier: MIT
#include "compensation/training/candidate_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compensation/inputs/features.h"
#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::candidate_evidence_test {
namespace {

using Names = std::vector<std::string>;

const std::vector<Input> kInputs = {
    parse_input("temperature"), parse_input("temperature_lowpass(100)"),
    parse_input("temperature_play(2)"), parse_input("since_power_on(700)")};
const Leg kUp{0, 0, -40.0, 50.0, 31}, kDown{0, 0, 50.0, -40.0, 31};

// The rows with the inputs above, filtered anew from each power-on.
TrainingRows with_inputs(const std::vector<Leg>& legs) {
  TrainingRows rows = rows_of(legs, [](double T, int) { return 0.01 * T; });
  rows.inputs.conservativeResize(Eigen::NoChange, 4);
  LowPass low_pass(100.0);
  Play play(2.0);
  double start = 0.0;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    if (k == 0 || rows.cycle(k) != rows.cycle(k - 1)) {
      low_pass.reset();
      play.reset();
      start = rows.time(k);
    }
    rows.inputs(k, 1) = low_pass.step(rows.time(k), rows.temperature(k));
    rows.inputs(k, 2) = play.step(rows.temperature(k));
    rows.inputs(k, 3) = std::exp((start - rows.time(k)) / 700.0);
  }
  return rows;
}

Names inputs_left(const std::vector<Leg>& legs, Grouping by = Grouping::kLeg,
                  RemovedInputs* removed = nullptr) {
  Candidate candidate{"bp(3)", kInputs, BpSpec{}};
  const TrainingRows rows = with_inputs(legs);
  const RemovedInputs found = remove_inputs_without_evidence(
      candidate, kInputs, rows, group_rows(rows, by));
  if (removed != nullptr) *removed = found;
  return input_names(candidate.inputs);
}

TEST(CandidateEvidence, LegsBothWaysBesideEachGroupTellThePastApart) {
  RemovedInputs removed;
  EXPECT_EQ(inputs_left({kUp, kDown, kUp, kDown}, Grouping::kLeg, &removed),
            (Names{"temperature", "temperature_lowpass(100)",
                   "temperature_play(2)"}));
  EXPECT_EQ(removed.names, Names{"since_power_on(700)"});
  EXPECT_TRUE(
      holds(removed.reason, "time since power-on is told from temperature by"));
}

// Without the one leg that falls the others all rise.
TEST(CandidateEvidence, OneLegDownAmongOthersTellsNothing) {
  for (const std::vector<Leg>& legs :
       {std::vector{kUp, kDown, kUp}, std::vector{kUp, kDown}}) {
    RemovedInputs removed;
    EXPECT_EQ(inputs_left(legs, Grouping::kLeg, &removed),
              (Names{"temperature"}));
    EXPECT_EQ(removed.names,
              (Names{"temperature_lowpass(100)", "temperature_play(2)",
                     "since_power_on(700)"}));
    EXPECT_TRUE(holds(removed.reason, "the past of the temperature is told"));
    EXPECT_TRUE(holds(removed.reason, "without leg"));
  }
}

// Each power-on starts with a lag of 0 and catches up: other lags at the same
// temperatures.
TEST(CandidateEvidence, PowerOnsAtThreeTemperaturesKeepTheTimeSincePowerOn) {
  std::vector<Leg> legs;
  for (int k = 0; k < 4; ++k)
    legs.push_back({k, k, -40.0 + 12.0 * k, 12.0 * k, 12});
  const Names left = inputs_left(legs, Grouping::kRun);
  EXPECT_EQ(left.back(), "since_power_on(700)");
}

TEST(CandidateEvidence, ToldApartAreValuesAtTheSameTemperature) {
  const Eigen::ArrayXd up = Eigen::ArrayXd::LinSpaced(40, 0.0, 40.0);
  Eigen::ArrayXd T(80), lag(80);
  T << up, up.reverse();
  lag << Eigen::ArrayXd::Constant(40, 3.0), Eigen::ArrayXd::Constant(40, -3.0);
  EXPECT_TRUE(is_told_apart(T, lag));
  EXPECT_FALSE(is_told_apart(up, Eigen::ArrayXd::Constant(40, 3.0)));
  EXPECT_FALSE(is_told_apart(up, 0.1 * up));
  EXPECT_FALSE(is_told_apart(Eigen::ArrayXd::Constant(80, 20.0), lag));
}

}  // namespace
}  // namespace beamgyro::internal::candidate_evidence_test
