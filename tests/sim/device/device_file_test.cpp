// SPDX-License-Identifier: MIT
#include "sim/device/device_file.h"

#include <gtest/gtest.h>

#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::device_file_test {
namespace {

TEST(DeviceFile, NominalUnitIsReadInSiUnits) {
  const DeviceParameters device = nominal_device();
  EXPECT_DOUBLE_EQ(device.mount.axis_angle, 2 * kDegree);
  EXPECT_DOUBLE_EQ(device.mount.glass_transition, 225.15);
  EXPECT_DOUBLE_EQ(device.readout.full_scale, 150 * kDegree);
  EXPECT_DOUBLE_EQ(device.readout.scale_factor * kDegree, 12.5e-3);
  EXPECT_DOUBLE_EQ(device.patches.offset[kFeedback], -5e-6);
  EXPECT_DOUBLE_EQ(device.bond.thickness[kReadout], 34e-6);
  EXPECT_DOUBLE_EQ(device.noise.angle_random_walk, 0.010 * kDegree);
  EXPECT_DOUBLE_EQ(device.noise.walk_correlation, 3.6e5);
  EXPECT_FALSE(device.beam.angular_gain.has_value());
}

TEST(DeviceFile, WhatIsWrongIsRefusedWithItsKeyAndValue) {
  const std::pair<std::string, std::string> values[] = {
      {"beam.length_m=-0.04", "beam.length_m"},
      {"beam.density_kg_per_m3=0", "beam.density_kg_per_m3"},
      {"beam.poisson_ratio=0.6", "beam.poisson_ratio"},
      {"beam.lenght_m=0.04", "length_m"},
      {"patches.length_m=0.05", "patches.length_m"},
      {"patches.offset_m=[1e-6, 2e-6]", "patches.offset_m"},
      {"bond.beta_step_Pa=2e9", "bond.beta_step_Pa"},
      {"bond.beta_exponent=1.5", "bond.beta_exponent"},
      {"mount.glass_transition_degC=-300", "mount.glass_transition_degC"},
      {"air.inverse_Q=-1e-5", "air.inverse_Q"},
      {"drive.voltage_limit_V=0", "drive.voltage_limit_V"},
      {"readout.mode=\"whole_angle\"", "open_loop"},
      {"readout.adc_bits=12.5", "readout.adc_bits"},
      {"readout.full_scale_deg_per_s=inf", "full_scale_deg_per_s"},
      {"noise.turn_on_deg_per_s=\"small\"", "noise.turn_on"},
      {"noise.random_walk_correlation_h=0.5", "random_walk_correlation_h"},
      {"memory.hysteresis.half_width_K=[0.5, 1.5, 1e-4, 10]", "half_width_K"},
      {"temperature_sensor.noise_K=-1", "temperature_sensor.noise_K"}};
  for (const auto& bad : values)
    EXPECT_TRUE(
        holds(rejection([&] { nominal_device({bad.first}); }), bad.second));
}

}  // namespace
}  // namespace beamgyro::internal::device_file_test
