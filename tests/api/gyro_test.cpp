// SPDX-License-Identifier: MIT
#include "include/beamgyro/gyro.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "include/beamgyro/simulate.h"

namespace beamgyro::internal::gyro_api_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

beamgyro::Device shipped(const char* name) {
  return beamgyro::Device::read(kScenarios / "devices" /
                                (std::string(name) + ".toml"));
}

std::vector<GyroInputs> some_inputs(std::size_t count) {
  std::vector<GyroInputs> inputs(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto x = static_cast<double>(k);
    inputs[k].rate = 40 * std::sin(0.1 * x);
    inputs[k].cross_rate_y = k > count / 2 ? 5 : 0;
    inputs[k].ambient_temperature = 25 + 0.01 * x;
    inputs[k].powered = k % 40 != 3;
  }
  return inputs;
}

TEST(PublicGyro, OnTheGridOfAScenarioItShowsTheSamplesOfItsRun) {
  const auto scenario =
      beamgyro::Scenario::read(kScenarios / "ten_minutes.toml");
  const Recording run = simulate(scenario).recording;
  const double ambient = column_values(run, "true_ambient_temperature").front();
  Gyro gyro(scenario.device(), {.seed = scenario.seed(),
                                .noise_rate_Hz = scenario.output_rate(),
                                .inputs = {.ambient_temperature = ambient}});
  std::size_t apart = 0;  // where one of the two rounds the other way
  const double lsb = 0.01;
  for (std::size_t k = 0; k < 2000; ++k) {
    if (k > 0)
      gyro.step(1 / scenario.output_rate(), {.ambient_temperature = ambient});
    EXPECT_NEAR(gyro.now().time, run.time[k], 1e-9);
    EXPECT_NEAR(gyro.now().rate, column_values(run, "rate")[k], lsb);
    if (std::abs(gyro.now().rate - column_values(run, "rate")[k]) > 1e-9)
      ++apart;
    EXPECT_NEAR(gyro.truth().true_bias, column_values(run, "true_bias")[k],
                5e-6);
  }
  EXPECT_LT(apart, 20U);
}

TEST(PublicGyro, AdvanceIsStepAfterStepToTheLastBit) {
  for (const GyroSteps steps : {GyroSteps::kHeld, GyroSteps::kLinear}) {
    const auto inputs = some_inputs(100);
    Gyro one(shipped("lifelike"), {.seed = 2}), all = one;
    const Recording recording = all.advance(0.01, inputs, steps);
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      const GyroInputs before =
          steps == GyroSteps::kLinear ? one.inputs() : inputs[k];
      one.step(0.01, before, inputs[k]);
      EXPECT_EQ(one.now().time, recording.time[k]);
      EXPECT_EQ(one.now().status, recording.status[k]);
      EXPECT_EQ(one.truth().true_bias,
                column_values(recording, "true_bias")[k]);
      if (inputs[k].powered) {
        EXPECT_EQ(one.now().rate, column_values(recording, "rate")[k]);
      }
    }
    EXPECT_EQ(one.state(), all.state());
    EXPECT_EQ(find_column(recording, "true_acceleration_x"), nullptr);
    EXPECT_NE(find_column(recording, "true_cross_rate_y"), nullptr);
    EXPECT_NE(find_column(recording, "true_hysteresis"), nullptr);
  }
}

TEST(PublicGyro, TheRecordingOfAnAdvanceIsAFile) {
  Gyro gyro(shipped("nominal"), {.seed = 2});
  const Recording made = gyro.advance(0.1, some_inputs(100));
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "advance.h5";
  write_recording(made, path);
  const Recording read = read_recording(path);
  EXPECT_EQ(read.time, made.time);
  EXPECT_EQ(read.device_text, gyro.device().text());
  std::filesystem::remove(path);
}

TEST(PublicGyro, StepAllIsEachStep) {
  const auto device = shipped("nominal");
  std::vector<Gyro> together, apart;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    together.emplace_back(device, GyroStart{.seed = seed});
    apart.push_back(together.back());
  }
  std::vector<Gyro*> gyros;
  for (Gyro& gyro : together) gyros.push_back(&gyro);
  auto inputs = some_inputs(gyros.size());
  for (const unsigned threads : {1U, 2U, 0U}) {
    step_all(gyros, 0.02, inputs, inputs, threads);
    for (std::size_t k = 0; k < apart.size(); ++k) {
      apart[k].step(0.02, inputs[k]);
      EXPECT_EQ(apart[k].state(), together[k].state());
    }
  }
  inputs[77].rate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(step_all(gyros, 0.02, inputs, inputs), std::invalid_argument);
  for (std::size_t k = 0; k < apart.size(); ++k)
    EXPECT_EQ(apart[k].state(), together[k].state());
  inputs[77].rate = 0;
  const std::vector<Gyro*> twice = {gyros[0], gyros[0]},
                           missing = {gyros[0], nullptr};
  const auto two = some_inputs(2);
  EXPECT_THROW(step_all(twice, 0.02, two, two), std::invalid_argument);
  EXPECT_THROW(step_all(missing, 0.02, two, two), std::invalid_argument);
  EXPECT_THROW(step_all(gyros, 0.02, two, two), std::invalid_argument);
}

TEST(PublicGyro, AStateBelongsToItsDeviceAndStart) {
  Gyro gyro(shipped("nominal"), {.seed = 1});
  gyro.step(0.1, {.rate = 3});
  const std::string state = gyro.state();
  Gyro same(shipped("nominal"), {.seed = 1});
  same.restore(state);
  EXPECT_EQ(same.state(), state);
  EXPECT_EQ(same.inputs().rate, 3);
  Gyro other_seed(shipped("nominal"), {.seed = 2});
  Gyro other_device(shipped("matched"), {.seed = 1});
  for (Gyro* other : {&other_seed, &other_device}) {
    const std::string before = other->state();
    EXPECT_THROW(other->restore(state), std::invalid_argument);
    EXPECT_EQ(other->state(), before);
  }
  for (const std::string& bytes :
       {std::string(), state.substr(0, state.size() / 2), state + "0"})
    EXPECT_THROW(same.restore(bytes), std::invalid_argument);
  EXPECT_EQ(same.state(), state);
}

TEST(PublicGyro, AFailureInTheMiddleOfAnAdvanceChangesNothing) {
  Gyro gyro(shipped("nominal"), {.seed = 1});
  gyro.step(0.1, {.rate = 3});
  const std::string before = gyro.state();
  auto inputs = some_inputs(50);
  inputs[30].ambient_temperature = 1e3;
  EXPECT_THROW(gyro.advance(0.1, inputs), std::invalid_argument);
  EXPECT_EQ(gyro.state(), before);
  EXPECT_THROW(gyro.advance(0.1, {}), std::invalid_argument);
  EXPECT_THROW(gyro.advance(0, some_inputs(2)), std::invalid_argument);
  EXPECT_EQ(gyro.state(), before);
}

TEST(PublicGyro, ABadStartSaysWhatWouldBeRight) {
  const auto device = shipped("nominal");
  EXPECT_THROW(Gyro(device, {.fidelity = "carrier"}), std::invalid_argument);
  EXPECT_THROW(Gyro(device, {.noise_rate_Hz = -1}), std::invalid_argument);
  EXPECT_THROW(Gyro(device, {.temperature_degC = -300}), std::invalid_argument);
  EXPECT_THROW(Gyro(device, {.age_hours = -1}), std::invalid_argument);
  EXPECT_THROW(Gyro(device, {.history = {{-10, 20}, {-5, 30}}}),
               std::invalid_argument);
  EXPECT_THROW(Gyro(device, {.history = {{0, 20}, {-5, 30}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::gyro_api_test
