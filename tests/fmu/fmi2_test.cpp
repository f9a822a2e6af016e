// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "config/units.h"
#include "sim/stepper/gyro_stepper.h"
#include "tests/fmu/importer.h"
#include "tests/sim/stepper/shipped_device.h"

namespace beamgyro::internal {
namespace {

constexpr double kStep = 0.1;  // [s]

// The same bits, so that NaN equals NaN.
void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]),
              std::bit_cast<std::uint64_t>(b[i]))
        << i << ": " << a[i] << ", " << b[i];
}

std::vector<double> engine_signals(const UnpackedFmu& fmu,
                                   const StepSample& sample) {
  std::vector<double> values;
  for (const std::uint32_t reference : fmu.signals())
    values.push_back(sampled_signal(reference, sample));
  return values;
}

double rate_at(int k) { return 40 * std::sin(0.3 * k); }           // [deg/s]
double ambient_at(int k) { return 25 + 0.5 * std::cos(0.2 * k); }  // [degC]

void set_inputs(Instance2& gyro, int k) {
  ASSERT_EQ(gyro.set("true_rate", rate_at(k)), kOk);
  ASSERT_EQ(gyro.set("ambient_temperature", ambient_at(k)), kOk);
  ASSERT_EQ(gyro.set("acceleration_z", k % 3), kOk);
  ASSERT_EQ(gyro.set_boolean("powered", k % 50 != 40), kOk);
}

StepInputs engine_inputs(int k) {
  StepInputs inputs;
  inputs.motion[kRateZ] = rate_at(k) * kDegree;
  inputs.motion[kAccelerationZ] = k % 3;
  inputs.ambient = ambient_at(k) + kZeroCelsius;
  return inputs;
}

struct Unit {
  const char* device;
  StepFidelity fidelity = StepFidelity::kQuasistatic;

  bool is_envelope() const { return fidelity == StepFidelity::kEnvelope; }
  UnpackedFmu fmu() const {
    return {device, FmiVersion::k2, "resources", "",
            is_envelope() ? "envelope" : "quasistatic"};
  }
};

class Fmi2 : public ::testing::TestWithParam<Unit> {};

TEST_P(Fmi2, StepsAsTheEngineToTheLastBit) {
  const UnpackedFmu fmu = GetParam().fmu();
  Instance2 gyro(fmu);
  ASSERT_EQ(gyro.set_integer("seed", -7), kOk);
  ASSERT_EQ(gyro.set_integer("seed_high", 3), kOk);
  ASSERT_EQ(gyro.set("noise_rate", 10), kOk);
  set_inputs(gyro, 0);
  ASSERT_EQ(gyro.start(), kOk);
  GyroStepper engine(
      stepper_model(make_gyro(shipped_device(GetParam().device))),
      {.fidelity = GetParam().fidelity,
       .seed = (std::uint64_t{3} << 32) + 0xfffffff9,
       .noise_rate = 10,
       .inputs = engine_inputs(0),
       .age = 0.0});
  expect_same(gyro.signals(), engine_signals(fmu, engine.now()));
  for (int k = 0; k < 100; ++k) {
    set_inputs(gyro, k);
    ASSERT_EQ(gyro.step(k * kStep, kStep), kOk) << gyro.messages.back();
    engine.step(kStep, engine_inputs(k), k % 50 != 40);
    expect_same(gyro.signals(), engine_signals(fmu, engine.now()));
  }
  EXPECT_TRUE(gyro.messages.empty());
}

TEST_P(Fmi2, GoesOnWithTheSameBytesFromAnyState) {
  const UnpackedFmu fmu = GetParam().fmu();
  Instance2 gyro(fmu), other(fmu);
  ASSERT_EQ(gyro.start(), kOk);
  std::vector<std::string> states;
  std::vector<std::vector<double>> shown;
  for (int k = 0; k < 12; ++k) {
    states.push_back(gyro.bytes());
    set_inputs(gyro, k);
    ASSERT_EQ(gyro.step(k * kStep, kStep), kOk);
    shown.push_back(gyro.signals());
  }
  for (int k = 11; k >= 0; --k) {
    ASSERT_EQ(other.restore(states[static_cast<std::size_t>(k)]), kOk);
    EXPECT_EQ(other.bytes(), states[static_cast<std::size_t>(k)]);
    set_inputs(other, k);
    ASSERT_EQ(other.step(k * kStep, kStep), kOk);
    expect_same(other.signals(), shown[static_cast<std::size_t>(k)]);
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, Fmi2,
                         ::testing::Values(Unit{"nominal"}, Unit{"lifelike"},
                                           Unit{"lifelike_with_modes"},
                                           Unit{"nominal",
                                                StepFidelity::kEnvelope}),
                         [](const auto& about) {
                           return std::string(about.param.device) +
                                  (about.param.is_envelope() ? "_envelope"
                                                             : "");
                         });

TEST(Fmi2Life, InterleavedInstancesDoNotSeeEachOther) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  Instance2 alone(fmu), first(fmu), second(fmu);
  ASSERT_EQ(second.set_integer("seed", 5), kOk);
  for (Instance2* gyro : {&alone, &first, &second})
    ASSERT_EQ(gyro->start(), kOk);
  std::vector<std::vector<double>> expected;
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(alone.step(k * kStep, kStep), kOk);
    expected.push_back(alone.signals());
  }
  int different = 0;
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(first.step(k * kStep, kStep), kOk);
    ASSERT_EQ(second.step(k * kStep, kStep), kOk);
    expect_same(first.signals(), expected[static_cast<std::size_t>(k)]);
    if (second.signals() != first.signals()) ++different;
  }
  // With another seed; the ADC's steps let few samples fall together.
  EXPECT_GT(different, 10);
}

TEST(Fmi2Life, AResetBeginsAnew) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  Instance2 gyro(fmu);
  const std::string fresh = gyro.bytes();
  ASSERT_EQ(gyro.set("beam.length_m", 0.041), kOk);
  ASSERT_EQ(gyro.start(), kOk);
  ASSERT_EQ(gyro.step(0, kStep), kOk);
  EXPECT_NE(gyro.bytes(), fresh);
  ASSERT_EQ(gyro.call("fmi2Reset"), kOk);
  EXPECT_EQ(gyro.bytes(), fresh);
}

TEST(Fmi2Life, ParametersAreKeysOfTheDevice) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2, "resources",
                        "readout.adc_bits=18");
  Instance2 gyro(fmu);
  ASSERT_EQ(gyro.set("beam.length_m", 0.041), kOk);
  ASSERT_EQ(gyro.set("patches.offset_m[2]", 1e-6), kOk);
  ASSERT_EQ(gyro.set("patches.offset_m[4]", 2e-6), kOk);
  ASSERT_EQ(gyro.set_integer("readout.adc_bits", 20), kOk);
  ASSERT_EQ(gyro.start(), kOk);
  const DeviceParameters device =
      shipped_device("nominal", {"beam.length_m=0.041", "readout.adc_bits=20",
                                 "patches.offset_m=[14e-6, 1e-6, 8e-6, 2e-6]"});
  const GyroStepper engine(stepper_model(make_gyro(device)), {});
  expect_same(gyro.signals(), engine_signals(fmu, engine.now()));
}

TEST(Fmi2Life, SignalsInInitializationFollowWhatIsSet) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  Instance2 gyro(fmu);
  ASSERT_EQ(gyro.set_up(), kOk);
  ASSERT_EQ(gyro.call("fmi2EnterInitializationMode"), kOk);
  const std::vector<std::uint32_t> beam = {
      fmu.reference("true_beam_temperature")};
  EXPECT_NEAR(gyro.get(beam)[0], 25, 1e-9);
  ASSERT_EQ(gyro.set("ambient_temperature", 30), kOk);
  EXPECT_NEAR(gyro.get(beam)[0], 30, 1e-9);
  ASSERT_EQ(gyro.set_boolean("starts_at_ambient", 0), kOk);
  ASSERT_EQ(gyro.set("start_temperature", -10), kOk);
  EXPECT_NEAR(gyro.get(beam)[0], -10, 1e-9);
}

TEST(Fmi2Life, DerivativesOfInputsMakeLines) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  Instance2 gyro(fmu);
  ASSERT_EQ(gyro.set_boolean("noise", 0), kOk);
  ASSERT_EQ(gyro.start(), kOk);
  const std::uint32_t rate = fmu.reference("true_rate");
  const std::int32_t order = 1;
  const double slope = 50;  // [deg/s2]
  ASSERT_EQ(gyro.call("fmi2SetRealInputDerivatives", &rate, std::size_t{1},
                      &order, &slope),
            kOk);
  ASSERT_EQ(gyro.step(0, kStep), kOk);
  GyroStepper engine(stepper_model(make_gyro(shipped_device("nominal"))),
                     {.noise = false});
  StepInputs end;
  end.motion[kRateZ] = slope * kStep * kDegree;
  engine.step(kStep, {}, end, true);
  expect_same(gyro.signals(), engine_signals(fmu, engine.now()));
  EXPECT_EQ(gyro.get({rate})[0], slope * kStep);
  ASSERT_EQ(gyro.step(kStep, kStep), kOk);  // held again
  EXPECT_EQ(gyro.get({rate})[0], slope * kStep);
}

TEST(Fmi2Life, TimeGoesOnFromTheStart) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  Instance2 gyro(fmu);
  ASSERT_EQ(gyro.set_up(100), kOk);
  ASSERT_EQ(gyro.call("fmi2EnterInitializationMode"), kOk);
  ASSERT_EQ(gyro.call("fmi2ExitInitializationMode"), kOk);
  double t = 100;  // a sum that drifts by rounding
  for (int k = 0; k < 1000; ++k, t += 0.001)
    ASSERT_EQ(gyro.step(t, 0.001), kOk) << gyro.messages.back();
  EXPECT_NEAR(gyro.get({fmu.reference("time")})[0], 101, 1e-12);
  double last = 0;
  EXPECT_EQ(gyro.call("fmi2GetRealStatus", 2, &last), kOk);
  EXPECT_NEAR(last, 101, 1e-12);
}

TEST(Fmi2Life, ResourcesAreFoundByAnEscapedUri) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2, "a folder of 100 %");
  Messages messages;
  Callbacks2 callbacks;
  callbacks.environment = &messages;
  const auto made = [&](const std::string& uri) {
    void* component = binary().call<void*>(
        "fmi2Instantiate", "gyro", 1, fmu.token().c_str(), uri.c_str(),
        static_cast<const Callbacks2*>(&callbacks), 0, 0);
    if (component != nullptr)
      binary().call<void>("fmi2FreeInstance", component);
    return component != nullptr;
  };
  std::string path;
  for (const char c : fmu.folder())
    path += c == ' ' ? "%20" : c == '%' ? "%25" : std::string(1, c);
  EXPECT_TRUE(made("file://" + path));
  EXPECT_TRUE(made("file:" + path));
  EXPECT_TRUE(made("file://localhost" + path));
  EXPECT_TRUE(messages.empty());
  for (const std::string& wrong :
       {fmu.folder(), "http://" + path, std::string("file://"),
        "file://" + path + "%zz", "file://" + path + "%2", "file:///not" + path,
        std::string()})
    EXPECT_FALSE(made(wrong)) << wrong;
  EXPECT_EQ(messages.size(), 7U);
}

TEST(Fmi2Life, EveryFunctionOfCoSimulationIsThere) {
  for (const char* name : {"GetTypesPlatform",
                           "GetVersion",
                           "SetDebugLogging",
                           "Instantiate",
                           "FreeInstance",
                           "SetupExperiment",
                           "EnterInitializationMode",
                           "ExitInitializationMode",
                           "Terminate",
                           "Reset",
                           "GetReal",
                           "GetInteger",
                           "GetBoolean",
                           "GetString",
                           "SetReal",
                           "SetInteger",
                           "SetBoolean",
                           "SetString",
                           "GetFMUstate",
                           "SetFMUstate",
                           "FreeFMUstate",
                           "SerializedFMUstateSize",
                           "SerializeFMUstate",
                           "DeSerializeFMUstate",
                           "GetDirectionalDerivative",
                           "SetRealInputDerivatives",
                           "GetRealOutputDerivatives",
                           "DoStep",
                           "CancelStep",
                           "GetStatus",
                           "GetRealStatus",
                           "GetIntegerStatus",
                           "GetBooleanStatus",
                           "GetStringStatus"})
    EXPECT_TRUE(binary().has(std::string("fmi2") + name)) << name;
  EXPECT_STREQ(binary().call<const char*>("fmi2GetVersion"), "2.0");
  EXPECT_STREQ(binary().call<const char*>("fmi2GetTypesPlatform"), "default");
}

TEST(Fmi2Life, TenThousandInstancesComeAndGo) {
  const UnpackedFmu fmu("nominal", FmiVersion::k2);
  for (int k = 0; k < 10000; ++k) Instance2 gyro(fmu);
  Instance2 gyro(fmu);
  void* forgotten = nullptr;  // is freed with its instance
  EXPECT_EQ(gyro.call("fmi2GetFMUstate", &forgotten), kOk);
}

}  // namespace
}  // namespace beamgyro::internal
