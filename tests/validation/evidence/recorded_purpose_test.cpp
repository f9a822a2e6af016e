// SPDX-License-Identifier: MIT
#include "validation/evidence/recorded_purpose.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "sim/scenario/simulation.h"
#include "sim/scenario/simulation_input.h"
#include "validation/qualification/qualification_file.h"
#include "validation/qualification/qualified_runs.h"

namespace beamgyro::internal::recorded_purpose_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

QualifiedDevice nominal_device() {
  const LoadedDevice loaded =
      load_device(kScenarios / "devices/nominal.toml", {});
  return {loaded.device, loaded.text, {}, 0};
}

}  // namespace

// What the columns tell is what the shipped qualification says, of every run.
TEST(RecordedPurpose, IsTheOneThatTheQualificationStates) {
  const Qualification qualification =
      read_qualification(kScenarios / "qualification.toml");
  const std::vector<Recording> runs =
      qualified_runs(qualification.runs, nominal_device(), 1);
  ASSERT_EQ(runs.size(), qualification.runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const QualificationRun& run = qualification.runs[k];
    EXPECT_EQ(purpose_name(recorded_purpose(runs[k])),
              purpose_name(run.purpose))
        << run.name;
  }
}

// A log tells no ambient temperature, and perhaps no temperature at all.
TEST(RecordedPurpose, OfALogIsToldFromTheMeasuredTemperature) {
  Recording log;
  for (int k = 0; k < 1200; ++k) log.time.push_back(k);
  log.status.assign(log.time.size(), 0);
  log.columns = {{"true_rate", "degree/s", "", Role::kTruth,
                  std::vector<double>(log.time.size(), 0.0)}};
  EXPECT_EQ(recorded_purpose(log), RunPurpose::kWarmUp);
  std::vector<double> temperature;
  for (const double t : log.time) temperature.push_back(20 + 0.02 * t);  // 24 K
  log.columns.push_back(
      {"temperature", "degC", "", Role::kMeasured, temperature});
  EXPECT_EQ(recorded_purpose(log), RunPurpose::kRamp);
  for (double& time : log.time) time *= 10;  // 3.3 h
  log.columns[1].values.assign(log.time.size(), 20.0);
  EXPECT_EQ(recorded_purpose(log), RunPurpose::kRest);
  log.columns.erase(log.columns.begin());
  EXPECT_THROW(recorded_purpose(log), std::invalid_argument);
}

}  // namespace beamgyro::internal::recorded_purpose_test
