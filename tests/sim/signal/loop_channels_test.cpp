// SPDX-License-Identifier: MIT
#include "sim/signal/loop_channels.h"

#include <gtest/gtest.h>

namespace beamgyro::internal::loop_channels_test {
namespace {

const std::vector<double> kWarming = {0, -65, 10};         // [K]
const std::vector<double> kAge = {0, kYear, 0.5 * kYear};  // [s]
const std::vector<double> kNoise = {0.5, -0.25, 1};

TEST(LoopChannels, WithoutErrorsShowTheValueItself) {
  const std::vector<double> value = {9081.5, 9080.25, 9079};
  EXPECT_EQ(measured_frequency({}, value, {}, kWarming, kAge), value);
  EXPECT_EQ(measured_voltage({}, value, {}, kWarming), value);
  EXPECT_EQ(measured_quadrature({}, value, {}, kWarming), value);
}

TEST(LoopChannels, AClockCountsWithOffsetTemperatureAndAge) {
  const LoopChannelParameters clock = {
      .clock_offset = 12e-6, .clock_tc2 = -0.034e-6, .clock_ageing = 3e-6};
  const std::vector<double> shown = measured_frequency(
      clock, std::vector<double>(3, 1e4), kNoise, kWarming, kAge);
  // ppm of 1e4 Hz are 0.01 Hz; 0.034 x 65^2 = 143.65, 0.034 x 10^2 = 3.4.
  EXPECT_NEAR(shown[0] - 1e4, 0.01 * 12 + 0.5, 1e-11);
  EXPECT_NEAR(shown[1] - 1e4, 0.01 * (12 - 143.65 + 3) - 0.25, 1e-11);
  EXPECT_NEAR(shown[2] - 1e4, 0.01 * (12 - 3.4 + 1.5) + 1, 1e-11);
}

TEST(LoopChannels, TheGainOfTheVoltageChangesWithTemperature) {
  const LoopChannelParameters gain = {.voltage_gain_error = 0.01,
                                      .voltage_gain_tc = 50e-6};
  const std::vector<double> shown =
      measured_voltage(gain, std::vector<double>(3, 0.8), kNoise, kWarming);
  EXPECT_NEAR(shown[0], 0.8 * 1.01 + 0.5, 1e-15);
  EXPECT_NEAR(shown[1], 0.8 * (1.01 - 65 * 50e-6) - 0.25, 1e-15);
  EXPECT_NEAR(shown[2], 0.8 * (1.01 + 10 * 50e-6) + 1, 1e-15);
}

TEST(LoopChannels, TheQuadratureHasAnOffsetOfItsOwn) {
  const LoopChannelParameters offset = {.quadrature_offset = 0.01,
                                        .quadrature_offset_tc = 2e-4,
                                        .quadrature_offset_tc2 = -1e-6};
  const std::vector<double> shown = measured_quadrature(
      offset, std::vector<double>(3, 0.7), kNoise, kWarming);
  EXPECT_NEAR(shown[0], 0.7 + 0.01 + 0.5, 1e-15);
  EXPECT_NEAR(shown[1], 0.7 + 0.01 - 65 * 2e-4 - 4225e-6 - 0.25, 1e-15);
  EXPECT_NEAR(shown[2], 0.7 + 0.01 + 10 * 2e-4 - 100e-6 + 1, 1e-15);
}

}  // namespace
}  // namespace beamgyro::internal::loop_channels_test
