// SPDX-License-Identifier: MIT
#include "sim/campaign/as_built.h"

#include <cmath>

namespace beamgyro::internal {

void set_as_built(const Trims& trims, const Gyro& base,
                  DeviceParameters& device) {
  ReadoutParameters& readout = device.readout;
  if (!trims.quadrature)
    readout.quadrature_trim = built_quadrature(device, base.stiffness_trim);
  if (trims.scale_factor && trims.offset) return;
  if (!trims.scale_factor) readout.scale_factor_error = 0;
  const Gyro gyro = make_gyro(device);
  double gain = 1;
  if (!trims.scale_factor) {
    gain = std::abs(gyro.rate_axis) / std::abs(base.rate_axis);
    readout.scale_factor_error = gain - 1;
  }
  if (!trims.offset) {
    const double untrimmed = readout.offset_trim - gyro.offset;  // [rad/s]
    readout.offset_trim = gain * untrimmed + base.offset;
  }
}

}  // namespace beamgyro::internal
