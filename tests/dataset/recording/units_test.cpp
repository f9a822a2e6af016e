// SPDX-License-Identifier: MIT
#include "dataset/recording/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/config/rejection.h"

namespace beamgyro::internal::units_test {
namespace {

TEST(Units, NumbersBecomeThoseOfARecording) {
  EXPECT_EQ(unit_conversion("K", "degC")(293.15), 20.0);
  EXPECT_EQ(unit_conversion("degF", "degC")(212.0), 100.0);
  EXPECT_EQ(unit_conversion("mV", "V")(2500.0), 2.5);
  EXPECT_EQ(unit_conversion("kHz", "Hz")(9.25), 9250.0);
  EXPECT_EQ(unit_conversion("rad/s", "degree/s")(std::numbers::pi), 180.0);
  EXPECT_NEAR(unit_conversion("deg/h", "degree/s")(3600.0), 1.0, 1e-15);
  EXPECT_EQ(unit_conversion("g", "m/s2")(1.0), 9.80665);
  EXPECT_TRUE(unit_conversion("deg/s", "degree/s").is_identity());
  EXPECT_TRUE(unit_conversion("1", "1").is_identity());
  EXPECT_TRUE(std::isnan(unit_conversion("K", "degC")(std::nan(""))));
}

TEST(Units, AnotherQuantityIsNoUnit) {
  EXPECT_EQ(rejection([] { unit_conversion("rad/s", "degC"); }),
            "the unit 'rad/s' is not known; expected degC, Celsius, K, Kelvin, "
            "degF");
  EXPECT_EQ(rejection([] { unit_conversion("", "1"); }),
            "the unit '' is not known; expected 1");
}

}  // namespace
}  // namespace beamgyro::internal::units_test
