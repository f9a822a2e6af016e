// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/campaign/campaign.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::as_built_test {
namespace {

constexpr Trims kNone{false, false, false};

// Another unit of the same design.
DeviceParameters drawn_unit(std::vector<std::string> more = {}) {
  more.insert(more.end(),
              {"patches.offset_m=[2e-6, -7e-6, 9e-6, -4e-6]",
               "beam.side_difference=-0.0095", "mount.axis_angle_deg=-1"});
  return nominal_device(more);
}

class AsBuilt : public testing::TestWithParam<std::string> {};

TEST_P(AsBuilt, TheBaseUnitHasItsOwnTrims) {
  const DeviceParameters base =
      nominal_device({GetParam(), "readout.scale_factor_error=0.03"});
  DeviceParameters built = base;
  set_as_built(kNone, make_gyro(base), built);
  // make_gyro trims to 1e-9 rad/s.
  EXPECT_NEAR(built.readout.quadrature_trim, base.readout.quadrature_trim,
              2e-9);
  EXPECT_NEAR(built.readout.offset_trim, base.readout.offset_trim, 1e-9);
  EXPECT_NEAR(built.readout.scale_factor_error, 0.03, 1e-9);
}

// A unit made with the keys as built has the settings of the base unit.
TEST_P(AsBuilt, AUnitKeepsTheBaseUnitsSettings) {
  const TrimmedGyro base = make_gyro(
      nominal_device({GetParam(), "readout.scale_factor_error=0.03"}));
  DeviceParameters built = drawn_unit({GetParam()});
  set_as_built(kNone, base, built);
  EXPECT_GT(std::abs(built.readout.quadrature_trim -
                     base.device.readout.quadrature_trim),
            10 * kDegree);
  EXPECT_GT(std::abs(built.readout.scale_factor_error - 0.03), 1e-4);
  const TrimmedGyro gyro = make_gyro(built);
  EXPECT_NEAR(gyro.stiffness_trim / base.stiffness_trim, 1, 1e-6);
  EXPECT_NEAR(std::abs(gyro.rate_axis) / std::abs(base.rate_axis), 1, 1e-9);
  EXPECT_NEAR(gyro.offset, base.offset, 1e-9);
}

TEST_P(AsBuilt, WhatIsTrimmedStaysAsItIs) {
  const TrimmedGyro base = make_gyro(nominal_device({GetParam()}));
  const DeviceParameters drawn =
      drawn_unit({GetParam(), "readout.scale_factor_error=-0.01"});
  DeviceParameters built = drawn;
  set_as_built({.quadrature = true, .offset = false, .scale_factor = true},
               base, built);
  EXPECT_EQ(built.readout.quadrature_trim, drawn.readout.quadrature_trim);
  EXPECT_EQ(built.readout.scale_factor_error, -0.01);
  EXPECT_NEAR(make_gyro(built).offset, base.offset, 1e-9);
  DeviceParameters trimmed = drawn;
  set_as_built({}, base, trimmed);
  EXPECT_EQ(trimmed.readout.offset_trim, drawn.readout.offset_trim);
}

INSTANTIATE_TEST_SUITE_P(OpenLoop, AsBuilt,
                         testing::Values("readout.mode=\"open_loop\""));
INSTANTIATE_TEST_SUITE_P(ForceRebalance, AsBuilt,
                         testing::Values("readout.mode=\"force_rebalance\""));

}  // namespace
}  // namespace beamgyro::internal::as_built_test
