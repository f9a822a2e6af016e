// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "config/units.h"
#include "sim/stepper/gyro_stepper.h"
#include "tests/fmu/importer.h"
#include "tests/sim/stepper/shipped_device.h"

namespace beamgyro::internal::fmi3 {
namespace {

constexpr std::size_t kOne = 1;
constexpr double kStep = 0.01;  // [s]

void log3(void* environment, int /*status*/, const char* /*category*/,
          const char* message) {
  static_cast<Messages*>(environment)->push_back(message);
}

class Fmi3 : public ::testing::Test {
 protected:
  Fmi3() : fmu_("lifelike", FmiVersion::k3) { component_ = made(false, 0); }
  void TearDown() override {
    binary().call<void>("fmi3FreeInstance", component_);
  }

  void* made(bool event_mode, std::size_t intermediate) {
    return binary().call<void*>(
        "fmi3InstantiateCoSimulation", "gyro", fmu_.token().c_str(),
        fmu_.folder().c_str(), false, false, event_mode, false,
        static_cast<const std::uint32_t*>(nullptr), intermediate,
        static_cast<void*>(&messages_), log3, static_cast<void*>(nullptr));
  }
  template <class... Arguments>
  int call(const char* name, Arguments... arguments) {
    return binary().call(name, component_, arguments...);
  }
  int enter(double start = 0) {
    return call("fmi3EnterInitializationMode", false, 0.0, start, false, 0.0);
  }
  template <class Value>
  int set(const char* function, const char* name, Value value) {
    const std::uint32_t reference = fmu_.reference(name);
    return call(function, &reference, kOne, &std::as_const(value), kOne);
  }
  int step(double time, double size) {
    bool event = true, end = true, early = true;
    double last = -1;
    const int answer =
        call("fmi3DoStep", time, size, false, &event, &end, &early, &last);
    if (answer == kOk) {
      EXPECT_FALSE(event || end || early);
      EXPECT_NEAR(last, time + size, 1e-9);
    }
    return answer;
  }
  std::vector<double> signals() {
    const std::vector<std::uint32_t> references = fmu_.signals();
    std::vector<double> values(references.size());
    EXPECT_EQ(call("fmi3GetFloat64", references.data(), references.size(),
                   values.data(), values.size()),
              kOk);
    return values;
  }

  UnpackedFmu fmu_;
  Messages messages_;
  void* component_ = nullptr;
};

TEST_F(Fmi3, StepsAsTheEngineToTheLastBit) {
  ASSERT_EQ(set("fmi3SetUInt64", "seed", std::uint64_t{0xfedcba9876543210}),
            kOk);
  ASSERT_EQ(set("fmi3SetFloat64", "age", 2.5), kOk);
  ASSERT_EQ(set("fmi3SetBoolean", "stirred", true), kOk);
  ASSERT_EQ(enter(50), kOk);
  ASSERT_EQ(call("fmi3ExitInitializationMode"), kOk);
  GyroStepper engine(
      stepper_model(make_gyro(shipped_device("lifelike"))),
      {.seed = 0xfedcba9876543210, .stirred = true, .age = 2.5 * 3600});
  for (int k = 0; k < 50; ++k) {
    const double rate = k % 7 - 3;  // [deg/s]
    ASSERT_EQ(set("fmi3SetFloat64", "true_cross_rate_y", rate), kOk);
    ASSERT_EQ(step(50 + k * kStep, kStep), kOk) << messages_.back();
    StepInputs inputs;
    inputs.motion[kRateY] = rate * kDegree;
    engine.step(kStep, inputs, true);
    const std::vector<std::uint32_t> references = fmu_.signals();
    const std::vector<double> shown = signals();
    for (std::size_t i = 0; i < shown.size(); ++i)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(shown[i]),
                std::bit_cast<std::uint64_t>(
                    sampled_signal(references[i], engine.now())))
          << references[i];
  }
  EXPECT_EQ(call("fmi3Terminate"), kOk);
  EXPECT_EQ(call("fmi3Reset"), kOk);
  EXPECT_TRUE(messages_.empty());
}

TEST_F(Fmi3, AStateGoesThroughBytes) {
  ASSERT_EQ(enter() + call("fmi3ExitInitializationMode"), kOk);
  ASSERT_EQ(step(0, kStep), kOk);
  void* state = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(call("fmi3GetFMUState", &state), kOk);
  ASSERT_EQ(call("fmi3SerializedFMUStateSize", state, &size), kOk);
  std::vector<std::uint8_t> bytes(size);
  ASSERT_EQ(call("fmi3SerializeFMUState", state, bytes.data(), size - 1),
            kError);
  ASSERT_EQ(call("fmi3SerializeFMUState", state, bytes.data(), size), kOk);
  ASSERT_EQ(step(kStep, kStep), kOk);
  const std::vector<double> shown = signals();
  ASSERT_EQ(call("fmi3FreeFMUState", &state), kOk);
  ASSERT_EQ(call("fmi3DeserializeFMUState",
                 static_cast<const std::uint8_t*>(bytes.data()), size, &state),
            kOk);
  ASSERT_EQ(call("fmi3SetFMUState", state), kOk);
  ASSERT_EQ(step(kStep, kStep), kOk);
  EXPECT_EQ(signals(), shown);
}

TEST_F(Fmi3, RefusesWhatItDoesNotHave) {
  EXPECT_EQ(made(true, 0), nullptr);
  EXPECT_EQ(made(false, 1), nullptr);
  EXPECT_EQ(messages_.size(), 2U);
  messages_.clear();
  for (const char* name :
       {"fmi3EnterConfigurationMode", "fmi3ExitConfigurationMode",
        "fmi3EnterStepMode", "fmi3EvaluateDiscreteStates",
        "fmi3EnterContinuousTimeMode"})
    EXPECT_EQ(call(name), kError) << name;
  EXPECT_EQ(call("fmi3SetTime", 1.0), kError);
  const std::uint32_t rate = fmu_.reference("true_rate");
  float single = 0;
  EXPECT_EQ(call("fmi3GetFloat32", &rate, kOne, &single, kOne), kError);
  double number = 0;
  EXPECT_EQ(call("fmi3GetFloat64", &rate, kOne, &number, std::size_t{2}),
            kError);
  std::int32_t integer = 0;
  const std::uint32_t seed = fmu_.reference("seed");
  EXPECT_EQ(call("fmi3GetInt32", &seed, kOne, &integer, kOne), kError);
  EXPECT_EQ(step(0, kStep), kError);
  EXPECT_EQ(messages_.size(), 10U);
}

TEST(Fmi3Functions, EveryFunctionOfTheStandardIsThere) {
  for (const char* name : {"GetVersion",
                           "SetDebugLogging",
                           "InstantiateModelExchange",
                           "InstantiateCoSimulation",
                           "InstantiateScheduledExecution",
                           "FreeInstance",
                           "EnterInitializationMode",
                           "ExitInitializationMode",
                           "EnterEventMode",
                           "Terminate",
                           "Reset",
                           "GetFloat32",
                           "GetFloat64",
                           "GetInt8",
                           "GetUInt8",
                           "GetInt16",
                           "GetUInt16",
                           "GetInt32",
                           "GetUInt32",
                           "GetInt64",
                           "GetUInt64",
                           "GetBoolean",
                           "GetString",
                           "GetBinary",
                           "GetClock",
                           "SetFloat32",
                           "SetFloat64",
                           "SetInt8",
                           "SetUInt8",
                           "SetInt16",
                           "SetUInt16",
                           "SetInt32",
                           "SetUInt32",
                           "SetInt64",
                           "SetUInt64",
                           "SetBoolean",
                           "SetString",
                           "SetBinary",
                           "SetClock",
                           "GetNumberOfVariableDependencies",
                           "GetVariableDependencies",
                           "GetFMUState",
                           "SetFMUState",
                           "FreeFMUState",
                           "SerializedFMUStateSize",
                           "SerializeFMUState",
                           "DeserializeFMUState",
                           "GetDirectionalDerivative",
                           "GetAdjointDerivative",
                           "EnterConfigurationMode",
                           "ExitConfigurationMode",
                           "GetIntervalDecimal",
                           "GetIntervalFraction",
                           "GetShiftDecimal",
                           "GetShiftFraction",
                           "SetIntervalDecimal",
                           "SetIntervalFraction",
                           "SetShiftDecimal",
                           "SetShiftFraction",
                           "EvaluateDiscreteStates",
                           "UpdateDiscreteStates",
                           "EnterContinuousTimeMode",
                           "CompletedIntegratorStep",
                           "SetTime",
                           "SetContinuousStates",
                           "GetContinuousStateDerivatives",
                           "GetEventIndicators",
                           "GetContinuousStates",
                           "GetNominalsOfContinuousStates",
                           "GetNumberOfEventIndicators",
                           "GetNumberOfContinuousStates",
                           "EnterStepMode",
                           "GetOutputDerivatives",
                           "DoStep",
                           "ActivateModelPartition"})
    EXPECT_TRUE(binary().has(std::string("fmi3") + name)) << name;
  EXPECT_STREQ(binary().call<const char*>("fmi3GetVersion"), "3.0");
}

}  // namespace
}  // namespace beamgyro::internal::fmi3
