// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "compensation/compensator/compensator.h"
#include "sensitivity/figures/static_curve.h"
#include "sim/device/device.h"

namespace beamgyro::internal {

/// Returns what is left of the bias [deg/s] at each temperature of `curve` when
/// `compensator` works on a gyro that has settled there: its low-passes have
/// ended and its warm-up is over. The sensor shows the temperature of the beam
/// and its offset, without noise and resolution; the other signals are those of
/// the curve. Throws std::invalid_argument naming an input that is not among
/// them.
Eigen::ArrayXd settled_residual(const Compensator& compensator,
                                const DeviceParameters& device,
                                const StaticCurve& curve);

}  // namespace beamgyro::internal
