// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "include/beamgyro/compensator.h"
#include "include/beamgyro/device.h"
#include "include/beamgyro/simulate.h"
#include "include/beamgyro/train.h"
#include "include/beamgyro/validate.h"
#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::compensate_api_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

Recording run_of(const std::vector<std::string>& overrides = {}) {
  return simulate(beamgyro::Scenario::read(kScenarios / "ten_minutes.toml",
                                           overrides))
      .recording;
}

std::vector<double> recorded_rate(const Recording& run) {
  return column_values(run, "rate");
}

TEST(UserCompensator, SeesTheMeasuredSignalsOfEachPoweredStretchOnly) {
  const Recording run =
      run_of({"power.on_s=[0,300]", "power.off_s=[200]"});  // two power cycles
  std::vector<std::size_t> sizes;
  const auto user = compensator_of("mine", {"rate", "temperature"},
                                   [&](const Recording& seen) {
                                     sizes.push_back(seen.time.size());
                                     EXPECT_EQ(seen.columns.size(), 2U);
                                     for (const Column& column : seen.columns) {
                                       EXPECT_EQ(column.role, Role::kMeasured);
                                       for (const double value : column.values)
                                         EXPECT_TRUE(std::isfinite(value));
                                     }
                                     return column_values(seen, "rate");
                                   });
  const Recording answered = compensate(*user, run).recording;
  const auto powered =
      std::ranges::count_if(run.status, [](auto s) { return (s & 1) == 0; });
  ASSERT_EQ(sizes.size(), 2U);
  EXPECT_EQ(sizes[0] + sizes[1], static_cast<std::size_t>(powered));
  const std::vector<double>& rate = column_values(answered, "compensated_rate");
  const std::vector<double>& recorded = column_values(run, "rate");
  for (std::size_t k = 0; k < rate.size(); ++k)
    if ((run.status[k] & kUnpowered) != 0)
      EXPECT_TRUE(std::isnan(rate[k])) << k;
    else
      EXPECT_EQ(rate[k], recorded[k]) << k;
  EXPECT_EQ(answered.compensator, "mine");
}

TEST(UserCompensator, IsNotGivenWhatCouldNotBeWritten) {
  Recording run = run_of();
  run.time[200] = run.time[100];
  const auto user = compensator_of("mine", {}, recorded_rate);
  EXPECT_THROW(compensate(*user, run), std::invalid_argument);
  const auto model = beamgyro::Model::read(kScenarios / "models/cubic.toml");
  EXPECT_THROW(train(model, {{"run", run}}), std::invalid_argument);
}

TEST(UserCompensator, TheFullScaleOfAValidationIsAPositiveNumber) {
  const auto user = compensator_of("mine", {}, recorded_rate);
  for (const double wrong : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(
        validate(*user, {.recordings = {"absent.h5"}, .full_scale = wrong}),
        std::invalid_argument)
        << wrong;
}

TEST(Characteristic, TemperaturesAreLimitedInTheirNumber) {
  EXPECT_EQ(even_temperatures(-40.0, 60.0, 0.25).size(), 401U);
  EXPECT_EQ(even_temperatures(60.0, -40.0, -100.0),
            (std::vector<double>{60.0, -40.0}));
  EXPECT_EQ(even_temperatures(5.0, 5.0, 1.0), std::vector<double>{5.0});
  EXPECT_EQ(even_temperatures(-99.6, 150.0, 0.1).back(), 150.0);
  EXPECT_EQ(even_temperatures(0.3, 0.0, -0.1).back(), 0.0);
  const double nan = std::nan("");
  for (const auto& [start, stop, step] :
       std::vector<std::array<double, 3>>{{-40.0, 60.0, 1e-9},
                                          {-40.0, 60.0, 1e-300},
                                          {0.0, 60.0, -1.0},
                                          {0.0, 60.0, 0.0},
                                          {0.0, 0.0, 0.0},
                                          {nan, 60.0, 1.0},
                                          {0.0, HUGE_VAL, 1.0},
                                          {0.0, 60.0, nan}})
    EXPECT_THROW(even_temperatures(start, stop, step), std::invalid_argument)
        << start << ' ' << stop << ' ' << step;
  const auto device =
      beamgyro::Device::read(kScenarios / "devices/nominal.toml");
  EXPECT_THROW(characterise(device, {}), std::invalid_argument);
}

TEST(UserCompensator, FaultsAndExceptionsReachTheCaller) {
  const Recording run = run_of();
  const auto few = compensator_of(
      "few", {"rate"}, [](const Recording&) { return std::vector<double>{1}; });
  EXPECT_THROW(compensate(*few, run), std::runtime_error);
  const auto broken =
      compensator_of("broken", {"rate"},
                     [](const Recording&) -> std::vector<double> { throw 42; });
  EXPECT_THROW(compensate(*broken, run), int);
  const auto truth = compensator_of(
      "cheat", {"true_rate"},
      [](const Recording& seen) { return column_values(seen, "true_rate"); });
  EXPECT_THROW(compensate(*truth, run), std::invalid_argument);
}

TEST(PublicCompensator, TextTrainsReadsAndAnswersAlike) {
  const auto scenario = beamgyro::Scenario::read(
      kScenarios / "ramp.toml", {"duration_s=20000", "output_rate_Hz=1"});
  const Recording run = simulate(scenario).recording;
  const auto model = beamgyro::Model::read(kScenarios / "models/cubic.toml");
  const TrainedCompensator trained =
      beamgyro::train(model, std::vector<NamedRecording>{{"ramp", run}});
  const auto again =
      Compensator::parse(trained.compensator.text(), "again.json");
  EXPECT_EQ(again.text(), trained.compensator.text());
  const CompensatedRate first = trained.compensator.answer(run);
  EXPECT_EQ(first.rate, again.answer(run).rate);
  // Most of the drift of a ramp is a cubic of the temperature.
  const auto rms = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size()));
  };
  EXPECT_LT(rms(first.rate), 0.5 * rms(column_values(run, "rate")));
  EXPECT_TRUE(holds(trained.text, "rms in-sample"));
  EXPECT_THROW(compensate(again, compensate(again, run).recording),
               std::invalid_argument);
}

TEST(PublicValidation, JudgesAUserCompensatorOnRecordings) {
  const TestDirectory folder;
  const auto file = folder.directory / "run.h5";
  write_recording(run_of(), file);
  std::atomic<int> calls = 0;
  const auto nothing =
      compensator_of("nothing", {"rate"}, [&](const Recording& seen) {
        ++calls;
        return column_values(seen, "rate");
      });
  const ValidationOutcome outcome = validate(*nothing, {.recordings = {file}});
  EXPECT_GT(calls, 0);
  EXPECT_NE(outcome.verdict, Verdict::kPass);  // it removes nothing
  EXPECT_FALSE(outcome.metrics.empty());
  EXPECT_FALSE(outcome.checks.empty());
  EXPECT_TRUE(holds(outcome.json, "\"nothing\""));
  EXPECT_THROW(validate(*nothing, {}), std::invalid_argument);
}

TEST(PublicValidation, ARecordingInMemoryIsJudgedAsItsFile) {
  const TestDirectory folder;
  const auto file = folder.directory / "run.h5";
  write_recording(run_of(), file);
  const Recording read = read_recording(file);
  const auto model = beamgyro::Model::read(kScenarios / "models/constant.toml");
  const Compensator constant =
      beamgyro::train(
          model, std::vector<NamedRecording>{{"other.h5", run_of({"seed=9"})}})
          .compensator;
  const ValidationOutcome of_file = validate(constant, {.recordings = {file}});
  const ValidationOutcome in_memory =
      validate(constant, {.recordings_in_memory = {{"run.h5", read}}});
  EXPECT_EQ(in_memory.text, of_file.text);
  EXPECT_EQ(in_memory.page.size(), of_file.page.size());  // but for its hash
  EXPECT_TRUE(holds(in_memory.json, "\"run.h5\""));
  const auto twice = [&] {
    validate(constant, {.recordings = {file},
                        .recordings_in_memory = {{"copy.h5", read}}});
  };
  EXPECT_TRUE(holds(rejection(twice), "copy.h5"));
  Recording damaged = read;
  damaged.time.back() = damaged.time.front();
  const auto of_damaged = [&] {
    validate(constant, {.recordings_in_memory = {{"bad", damaged}}});
  };
  EXPECT_TRUE(holds(rejection(of_damaged), "bad"));
  const auto both = [&] {
    validate(
        constant,
        {.device = beamgyro::Device::read(kScenarios / "devices/nominal.toml"),
         .recordings_in_memory = {{"run", read}}});
  };
  EXPECT_TRUE(holds(rejection(both), "expected one of them"));
}

TEST(PublicValidation, ARunOfTrainingIsKnownInMemory) {
  const Recording run = run_of();
  const auto model = beamgyro::Model::read(kScenarios / "models/constant.toml");
  const Compensator constant =
      beamgyro::train(model, std::vector<NamedRecording>{{"run", run}})
          .compensator;
  const ValidationOutcome outcome =
      validate(constant, {.recordings_in_memory = {{"again", run}}});
  const auto found =
      std::ranges::find(outcome.checks, "hold_out", &CheckRow::name);
  ASSERT_NE(found, outcome.checks.end());
  EXPECT_EQ(found->outcome, "failed");
}

}  // namespace
}  // namespace beamgyro::internal::compensate_api_test
