// SPDX-License-Identifier: MIT
#include "compensation/inputs/input.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/config/rejection.h"

namespace beamgyro::internal::input_test {
namespace {

TEST(Input, NameReadsBackToTheSameInput) {
  for (const char* name :
       {"output", "rate", "temperature", "drive_frequency", "drive_voltage",
        "quadrature", "temperature_lowpass(100)", "temperature_lowpass(0.3)",
        "temperature_rate(60)", "temperature_play(1.5)",
        "quadrature_lowpass(10)", "drive_voltage_lowpass(2.5)",
        "since_power_on(412.5)"}) {
    const Input input = parse_input(name);
    EXPECT_EQ(input_name(input), name);
    EXPECT_EQ(parse_input(input_name(input)), input);
  }
}

TEST(Input, FilterKnowsItsColumnAndTimeConstant) {
  const Input low_passed = parse_input("temperature_lowpass(1e2)");
  EXPECT_EQ(low_passed.column, "temperature");
  EXPECT_EQ(low_passed.parameter, 100.0);
  EXPECT_EQ(parse_input("temperature_rate(60)").column, "temperature");
  EXPECT_EQ(parse_input("quadrature_lowpass(10)").column, "quadrature");
  EXPECT_EQ(parse_input("drive_voltage_lowpass(10)").column, "drive_voltage");
  EXPECT_EQ(parse_input("since_power_on(300)").column, "");
}

TEST(Input, OutputAndRateAloneFeelTheRate) {
  for (const char* name : {"output", "rate"})
    EXPECT_TRUE(sees_the_rate(parse_input(name))) << name;
  for (const char* name : {"temperature", "temperature_lowpass(100)",
                           "temperature_rate(60)", "since_power_on(300)",
                           "drive_frequency", "drive_voltage", "quadrature"})
    EXPECT_FALSE(sees_the_rate(parse_input(name))) << name;
}

TEST(Input, TruthIsNoInput) {
  for (const char* name :
       {"true_rate", "true_bias", "true_beam_temperature", "status", "time"})
    EXPECT_THROW(parse_input(name), std::invalid_argument) << name;
}

TEST(Input, WrongNameIsAnsweredWithTheNearestOne) {
  EXPECT_TRUE(holds(rejection([] { parse_input("temprature"); }),
                    "did you mean \"temperature\"?"));
  EXPECT_TRUE(holds(rejection([] { parse_input("since_power(3)"); }),
                    "did you mean \"since_power_on\"?"));
}

TEST(Input, PlayNeedsOnePositiveHalfWidthInKelvin) {
  EXPECT_EQ(parse_input("temperature_play(4)").column, "temperature");
  EXPECT_FALSE(sees_the_rate(parse_input("temperature_play(4)")));
  for (const char* name :
       {"temperature_play", "temperature_play(0)", "temperature_play(-2)",
        "temperature_play(inf)", "temperature_play(2", "temperature_play(2 K)"})
    EXPECT_TRUE(holds(rejection([&] { parse_input(name); }),
                      "one positive half-width in K, as temperature_play(2)"))
        << name;
}

TEST(Input, FilterNeedsOnePositiveTimeConstant) {
  for (const char* name :
       {"temperature_lowpass", "temperature_lowpass()", "since_power_on(0)",
        "temperature_lowpass(-5)", "temperature_lowpass(nan)",
        "since_power_on(inf)", "temperature_lowpass(100", "since_power_on(1,2)",
        "temperature_lowpass(100)x", "temperature_rate",
        "temperature_rate(-1)"})
    EXPECT_TRUE(holds(rejection([&] { parse_input(name); }),
                      "one positive time constant in s"))
        << name;
}

}  // namespace
}  // namespace beamgyro::internal::input_test
