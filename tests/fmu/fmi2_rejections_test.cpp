// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/fmu/importer.h"

namespace beamgyro::internal::fmi2_rejections {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kOne = 1;

// A call that is refused, and what its message says.
struct Refusal {
  const char* says;
  std::function<int(Instance2&)> call;
};

void expect_refused(Instance2& gyro, const std::vector<Refusal>& refusals) {
  const std::string before = gyro.bytes();
  for (const Refusal& refusal : refusals) {
    gyro.messages.clear();
    EXPECT_EQ(refusal.call(gyro), kError) << refusal.says;
    ASSERT_EQ(gyro.messages.size(), kOne) << refusal.says;
    EXPECT_NE(gyro.messages[0].find(refusal.says), std::string::npos)
        << gyro.messages[0];
    EXPECT_EQ(gyro.bytes(), before) << refusal.says;
  }
}

Refusal sets(const char* name, double value, const char* says) {
  return {says, [=](Instance2& g) { return g.set(name, value); }};
}
Refusal steps(double time, double size, const char* says) {
  return {says, [=](Instance2& g) { return g.step(time, size); }};
}
template <class... Arguments>
Refusal calls(const char* says, const char* name, Arguments... arguments) {
  return {says, [=](Instance2& g) { return g.call(name, arguments...); }};
}
// Gets or sets one value by its reference.
template <class Value>
Refusal of_value(const char* says, const char* name, std::uint32_t reference,
                 Value value) {
  return {says, [=](Instance2& g) {
            Value own = value;
            return g.call(name, &reference, kOne, &own);
          }};
}

const UnpackedFmu& nominal() {
  static const UnpackedFmu fmu("nominal", FmiVersion::k2);
  return fmu;
}

TEST(Fmi2Rejections, BetweenSteps) {
  Instance2 gyro(nominal());
  ASSERT_EQ(gyro.start(), kOk);
  ASSERT_EQ(gyro.step(0, 0.1), kOk);
  const std::uint32_t none = 999, key = kFirstKey + 5000;
  const std::uint32_t output = nominal().reference("output");
  const std::uint32_t rate = nominal().reference("true_rate");
  expect_refused(
      gyro,
      {steps(0.1, 0, "step size is 0"),
       steps(0.1, -0.1, "step size is -0.1"),
       steps(0.1, kNaN, "step size is nan"),
       steps(0.1, kInfinity, "step size is inf"),
       steps(0.1, 1e6, "1e+06 s; expected above 0, at most 100000 s"),
       steps(0, 0.1, "begins at 0"),
       steps(0.2, 0.1, "begins at 0.2"),
       steps(kNaN, 0.1, "begins at nan"),
       steps(kInfinity, 0.1, "begins at"),
       sets("true_rate", 1e5, "true_rate is 100000"),
       sets("true_rate", kNaN, "true_rate is nan"),
       sets("true_cross_rate_x", -1e5, "true_cross_rate_x is"),
       sets("acceleration_y", 1e7, "acceleration_y is"),
       sets("ambient_temperature", 151, "expected a number in [-100, 150]"),
       sets("ambient_temperature", -kInfinity, "ambient_temperature is -inf"),
       sets("beam.length_m", 0.04, "beam.length_m cannot be set"),
       sets("noise_rate", 10, "noise_rate cannot be set"),
       sets("output", 1, "output cannot be set"),
       sets("true_bias", 1, "true_bias cannot be set"),
       sets("time", 1, "time cannot be set"),
       {"seed cannot be set",
        [](Instance2& g) { return g.set_integer("seed", 1); }},
       {"noise cannot be set",
        [](Instance2& g) { return g.set_boolean("noise", 1); }},
       of_value("reference 999", "fmi2GetReal", none, 0.0),
       of_value("reference 999", "fmi2SetReal", none, 0.0),
       of_value("reference 6000", "fmi2GetReal", key, 0.0),
       of_value("of another type", "fmi2GetInteger", output, 0),
       of_value("of another type", "fmi2GetBoolean", output, 0),
       of_value("of another type", "fmi2SetBoolean", output, 0),
       of_value("type String", "fmi2GetString", output, ""),
       of_value("type String", "fmi2SetString", output, ""),
       calls("array is missing", "fmi2GetReal", &rate, kOne,
             static_cast<double*>(nullptr)),
       calls("set-up", "fmi2SetupExperiment", 0, 0.0, 0.0, 0, 0.0),
       calls("begin of initialization is not allowed",
             "fmi2EnterInitializationMode"),
       calls("end of initialization is not allowed",
             "fmi2ExitInitializationMode"),
       calls("steps that wait", "fmi2CancelStep"),
       calls("directional", "fmi2GetDirectionalDerivative",
             static_cast<const std::uint32_t*>(nullptr), std::size_t{0},
             static_cast<const std::uint32_t*>(nullptr), std::size_t{0},
             static_cast<const double*>(nullptr),
             static_cast<double*>(nullptr)),
       calls("none of this instance", "fmi2SetFMUstate",
             static_cast<void*>(gyro.component)),
       {"order 1",
        [=](Instance2& g) {
          const std::int32_t order = 2;
          const double value = 1;
          return g.call("fmi2SetRealInputDerivatives", &rate, kOne, &order,
                        &value);
        }},
       {"order 1",
        [=](Instance2& g) {
          const std::int32_t order = 1;
          return g.call("fmi2SetRealInputDerivatives", &rate, kOne, &order,
                        &kNaN);
        }},
       {"log has no category", [](Instance2& g) {
          const char* const category = "all 100%";
          return g.call("fmi2SetDebugLogging", 1, kOne, &category);
        }}});
}

TEST(Fmi2Rejections, OneWrongValueLeavesTheOthers) {
  Instance2 gyro(nominal());
  ASSERT_EQ(gyro.start(), kOk);
  expect_refused(gyro, {{"acceleration_x is nan", [](Instance2& g) {
                           const std::uint32_t references[] = {
                               nominal().reference("true_rate"),
                               nominal().reference("acceleration_x")};
                           const double values[] = {20, kNaN};
                           return g.call("fmi2SetReal", &references[0],
                                         std::size_t{2}, &values[0]);
                         }}});
}

TEST(Fmi2Rejections, BeforeAndAfterTheSteps) {
  Instance2 gyro(nominal());
  const std::uint32_t output = nominal().reference("output");
  expect_refused(
      gyro, {steps(0, 0.1, "a step is not allowed"),
             of_value("a look at a signal", "fmi2GetReal", output, 0.0),
             calls("the end is not allowed", "fmi2Terminate"),
             calls("end of initialization", "fmi2ExitInitializationMode"),
             calls("from nan", "fmi2SetupExperiment", 0, 0.0, kNaN, 0, 0.0),
             calls("from 2 to 1", "fmi2SetupExperiment", 0, 0.0, 2.0, 1, 1.0),
             sets("beam.length_m", 1, "beam.length_m is 1; expected"),
             sets("noise_rate", -1, "noise_rate is -1"),
             sets("age", kInfinity, "age is inf"),
             {"adc_bits is 33", [](Instance2& g) {
                return g.set_integer("readout.adc_bits", 33);
              }}});
  ASSERT_EQ(gyro.call("fmi2SetupExperiment", 0, 0.0, 0.0, 1, 0.2), kOk);
  ASSERT_EQ(gyro.call("fmi2EnterInitializationMode"), kOk);
  ASSERT_EQ(gyro.set("patches.length_m", 0.041), kOk);
  expect_refused(
      gyro, {calls("less than beam.length_m", "fmi2ExitInitializationMode")});
  ASSERT_EQ(gyro.set("patches.length_m", 0.012), kOk);
  ASSERT_EQ(gyro.call("fmi2ExitInitializationMode"), kOk);
  expect_refused(gyro, {steps(0, 0.3, "no later than the stop time")});
  ASSERT_EQ(gyro.call("fmi2Terminate"), kOk);
  expect_refused(gyro, {steps(0, 0.1, "a step is not allowed"),
                        sets("true_rate", 1, "cannot be set after the end"),
                        calls("the end is not allowed", "fmi2Terminate")});
}

TEST(Fmi2Rejections, ForeignBytesAreNoState) {
  const UnpackedFmu changed("nominal", FmiVersion::k2, "changed",
                            "beam.length_m=0.041");
  Instance2 gyro(nominal()), other(changed);
  ASSERT_EQ(gyro.start(), kOk);
  ASSERT_EQ(other.start(), kOk);
  const std::string good = gyro.bytes();
  std::vector<Refusal> refusals;
  const auto add = [&](const std::string& bytes) {
    refusals.push_back({"no state of this device",
                        [=](Instance2& g) { return g.restore(bytes); }});
  };
  add("");
  add("\n\n\n\n\n");
  add(other.bytes());
  add(good + " ");
  for (std::size_t i = 0; i < good.size(); i += 97) {
    std::string bytes = good;
    bytes[i] = static_cast<char>(bytes[i] ^ 1);
    add(bytes);
    add(good.substr(0, i));
  }
  expect_refused(gyro, refusals);
  EXPECT_EQ(gyro.restore(good), kOk);
}

TEST(Fmi2Rejections, NoInstanceWithoutItsToken) {
  Messages messages;
  Callbacks2 callbacks;
  callbacks.environment = &messages;
  const auto refused = [&](const char* name, int type, const char* token) {
    messages.clear();
    EXPECT_EQ(binary().call<void*>(
                  "fmi2Instantiate", name, type, token, nominal().uri().c_str(),
                  static_cast<const Callbacks2*>(&callbacks), 0, 0),
              nullptr);
    ASSERT_EQ(messages.size(), kOne);
  };
  const char* const token = nominal().token().c_str();
  refused("gyro", 1, "100 %d %s%n");
  EXPECT_NE(messages[0].find("100 %d %s%n"), std::string::npos);
  refused("gyro", 1, nullptr);
  refused("", 1, token);
  refused(nullptr, 1, token);
  refused("gyro", 0, token);
  EXPECT_NE(messages[0].find("no model exchange"), std::string::npos);
  EXPECT_EQ(binary().call("fmi2Reset", static_cast<void*>(nullptr)), kError);
}

}  // namespace
}  // namespace beamgyro::internal::fmi2_rejections
