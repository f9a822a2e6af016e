// SPDX-License-Identifier: MIT
#include "sim/campaign/as_built.h"

#include <cmath>

namespace beamgyro {

void set_as_built(const Trims& trims, const Gyro& base, Device& device) {
  ReadoutParameters& readout = device.readout;
  if (!trims.quadrature)
    readout.quadrature_trim = built_quadrature(device, base.stiffness_trim);
  if (!trims.scale_factor) {
    readout.scale_factor_error = 0;
    readout.scale_factor_error =
        std::abs(make_gyro(device).rate_axis) / std::abs(base.rate_axis) - 1;
  }
  if (!trims.offset) {
    // make_gyro's offset is what takes the output to the trim.
    readout.offset_trim += base.offset - make_gyro(device).offset;
  }
}

}  // namespace beamgyro
