// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>

namespace beamgyro::internal {

/// Returns std::round(value) to the last bit, without a call, so that loops
/// vectorise.
inline double rounded(double value) {
  const double size = std::abs(value);
  double whole = (size + 0x1p52) - 0x1p52;  // nearest, halves to even
  whole += size - whole == 0.5 ? 1.0 : 0.0;
  return size < 0x1p52 ? std::copysign(whole, value) : value;
}

/// Returns the multiple of `resolution` nearest to `value`, halves away from
/// zero. A resolution of 0 leaves the value as it is. Both have the same unit.
/// Throws std::invalid_argument for a resolution below 0 or not finite.
double quantise(double value, double resolution);
void quantise(std::span<double> values, double resolution);

struct ReadoutSample {
  double voltage;  // [V]
  bool saturated;
};

/// The end of the readout: an amplifier that clips at +-full scale, an ADC over
/// +-full scale, and the scaling to the voltage of the pin
///   code = round(clip(rate) / LSB), LSB = 2 full_scale / 2^bits, mid-tread,
///   -2^(bits-1) <= code <= 2^(bits-1) - 1,
///   V = offset + scale_factor LSB code.
class Readout {
 public:
  /// full_scale [rad/s] > 0, adc_bits 1..32, scale_factor [V/(rad/s)] not 0,
  /// offset [V]. Throws std::invalid_argument otherwise.
  Readout(double full_scale, int adc_bits, double scale_factor, double offset);

  /// Returns the voltage of the pin at a rate-equivalent signal [rad/s].
  /// `saturated` is set when the signal is beyond full scale or the code was
  /// held at its limit. NaN stays NaN.
  ReadoutSample sample(double rate) const;

  double lsb() const { return lsb_; }  // [rad/s]

 private:
  double full_scale_, lsb_;       // [rad/s]
  double lowest_, highest_;       // codes
  double scale_factor_, offset_;  // [V/(rad/s)] [V]
};

}  // namespace beamgyro::internal
