// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "sim/numerics/piecewise_linear.h"

namespace beamgyro::internal {

/// offset + amplitude sin(2 pi frequency t + phase)
struct SineSignal {
  double offset = 0.0;
  double amplitude = 0.0;
  double frequency = 0.0;  // [Hz]
  double phase = 0.0;      // [rad]
};

/// A signal over time.
using Signal = std::variant<SineSignal, PiecewiseLinear>;

/// Writes the next samples of a signal to the span, as many as it holds.
using SampleStream = std::function<void(std::span<double>)>;

/// The readout's output filter, two equal real poles w_o:
///   y_1' = w_o (u - y_1),   y_2' = w_o (y_1 - y_2),
/// solved exactly.
class OutputFilter {
 public:
  /// `corner` is w_o [rad/s] of each pole: the pair is -3 dB at 0.644 w_o.
  /// Throws std::invalid_argument unless finite and above 0.
  explicit OutputFilter(double corner);

  /// H(i omega) = (1 + i omega / w_o)^-2, omega in [rad/s].
  std::complex<double> gain(double omega) const;

  /// Returns y_2 at the times k / output_rate, k = 0, 1, ..., in the units of
  /// u. The input must outlive the stream. The response is:
  /// - to a profile, whose jumps and bends may lie anywhere between the
  /// samples;
  ///   at t = 0 the filter has settled on its value there;
  /// - to a sine, the periodic response.
  /// Throws std::invalid_argument for an output rate [Hz] that is not finite
  /// and > 0.
  SampleStream responses(const Signal& input, double output_rate) const;

  /// Returns the first `count` values of responses().
  std::vector<double> response(const Signal& input, double output_rate,
                               std::size_t count) const;

 private:
  double corner_;  // [rad/s]
};

}  // namespace beamgyro::internal
