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
  EXPECT_FALSE(device.beam.angular_gain.has_value());
}

struct BadValue {
  const char* override_text;
  const char* expected;  // part of the message
};

class DeviceFileRejects : public testing::TestWithParam<BadValue> {};

TEST_P(DeviceFileRejects, NamesTheKeyAndTheValue) {
  EXPECT_TRUE(
      holds(rejection([] { nominal_device({GetParam().override_text}); }),
            GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    EveryTable, DeviceFileRejects,
    testing::Values(
        BadValue{"beam.length_m=-0.04", "beam.length_m"},
        BadValue{"beam.density_kg_per_m3=0", "beam.density_kg_per_m3"},
        BadValue{"beam.poisson_ratio=0.6", "beam.poisson_ratio"},
        BadValue{"beam.lenght_m=0.04", "length_m"},
        BadValue{"patches.length_m=0.05", "patches.length_m"},
        BadValue{"patches.offset_m=[1e-6, 2e-6]", "patches.offset_m"},
        BadValue{"bond.beta_step_Pa=2e9", "bond.beta_step_Pa"},
        BadValue{"bond.beta_exponent=1.5", "bond.beta_exponent"},
        BadValue{"mount.glass_transition_degC=-300",
                 "mount.glass_transition_degC"},
        BadValue{"air.inverse_Q=-1e-5", "air.inverse_Q"},
        BadValue{"drive.voltage_limit_V=0", "drive.voltage_limit_V"},
        BadValue{"readout.mode=\"whole_angle\"", "open_loop"},
        BadValue{"readout.adc_bits=12.5", "readout.adc_bits"},
        BadValue{"readout.full_scale_deg_per_s=inf", "full_scale_deg_per_s"},
        BadValue{"noise.turn_on_deg_per_s=\"small\"", "noise.turn_on"},
        BadValue{"temperature_sensor.noise_K=-1",
                 "temperature_sensor.noise_K"}));

}  // namespace
}  // namespace beamgyro::internal::device_file_test
