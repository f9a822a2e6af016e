// SPDX-License-Identifier: MIT
#include "sim/signal/readout.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

namespace beamgyro::internal {

double quantise(double value, double resolution) {
  quantise({&value, 1}, resolution);
  return value;
}

void quantise(std::span<double> values, double resolution) {
  if (!(resolution >= 0.0) || !std::isfinite(resolution))
    throw std::invalid_argument(
        fmt::format("resolution is {}, must be 0 or more", resolution));
  if (resolution == 0.0) return;
  for (double& v : values) v = resolution * rounded(v / resolution);
}

Readout::Readout(double full_scale, int adc_bits, double scale_factor,
                 double offset)
    : full_scale_(full_scale), scale_factor_(scale_factor), offset_(offset) {
  if (!(full_scale > 0.0) || !std::isfinite(full_scale))
    throw std::invalid_argument(
        fmt::format("full scale is {} rad/s, must be above 0", full_scale));
  if (adc_bits < 1 || adc_bits > 32)
    throw std::invalid_argument(
        fmt::format("ADC has {} bits, must be 1 to 32", adc_bits));
  if (scale_factor == 0.0 || !std::isfinite(scale_factor))
    throw std::invalid_argument(fmt::format(
        "scale factor is {} V/(rad/s), must not be 0", scale_factor));
  if (!std::isfinite(offset))
    throw std::invalid_argument(
        fmt::format("output offset is {} V, must be finite", offset));
  const double half_codes = std::ldexp(1.0, adc_bits - 1);
  lsb_ = full_scale / half_codes;
  lowest_ = -half_codes;
  highest_ = half_codes - 1.0;
}

ReadoutSample Readout::sample(double rate) const {
  const double clipped = std::clamp(rate, -full_scale_, full_scale_);
  const double ideal_code = rounded(clipped / lsb_);
  const double code = std::clamp(ideal_code, lowest_, highest_);
  return {offset_ + scale_factor_ * lsb_ * code,
          std::abs(rate) > full_scale_ || ideal_code > highest_};
}

}  // namespace beamgyro::internal
