// SPDX-License-Identifier: MIT
#include "sim/signal/output_filter.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamgyro {
namespace {

void require_positive(double value, const char* name, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("{} is {} {}, must be above 0", name, value, unit));
}

// A transient that has died out is 0: halved for ever it would stay a
// subnormal number, and those are a hundred times slower.
double alive(double transient) {
  return std::abs(transient) < 1e-290 ? 0.0 : transient;
}

// A stretch of time in which the input is linear.
struct Stretch {
  double x;           // w_o h
  double decay;       // e^-x
  double mean_decay;  // (1 - e^-x) / x
};

Stretch stretch(double corner, double duration) {
  const double x = corner * duration;
  const double lost = -std::expm1(-x);
  return {x, 1.0 - lost, x > 0.0 ? lost / x : 1.0};
}

struct TwoPoles {
  double first, second;  // y_1, y_2

  // Over the stretch the input runs from `input` to `input + rise`. Written in
  // the differences to the input, with nothing large that cancels however steep
  // the rise.
  void advance(const Stretch& h, double input, double rise) {
    const double behind1 = alive(first - input);
    const double behind2 = alive(second - input);
    const double end = input + rise;
    first = end + h.decay * behind1 - rise * h.mean_decay;
    second = end + h.decay * (behind2 + h.x * behind1) +
             rise * (h.decay - 2.0 * h.mean_decay);
  }
};

}  // namespace

OutputFilter::OutputFilter(double corner) : corner_(corner) {
  require_positive(corner, "output filter corner", "rad/s");
}

std::complex<double> OutputFilter::gain(double omega) const {
  const std::complex<double> pole(1.0, omega / corner_);
  return 1.0 / (pole * pole);
}

std::vector<double> OutputFilter::response(const PiecewiseLinear& input,
                                           double output_rate,
                                           std::size_t count) const {
  require_positive(output_rate, "output rate", "Hz");
  const std::vector<double> breaks = input.breakpoints();
  const std::vector<double> break_values = input.sample(breaks);
  std::size_t next = 0;  // first break after `now`
  while (next < breaks.size() && breaks[next] <= 0.0) ++next;

  if (next == breaks.size()) return std::vector(count, input.value(0.0));

  double now = 0.0;
  double start = 0.0, start_value = 0.0, slope = 0.0;  // of the linear piece
  const auto begin_piece = [&](double value) {
    start = now;
    start_value = value;
    slope = next == breaks.size() ? 0.0
                                  : (input.value_before(breaks[next]) - value) /
                                        (breaks[next] - now);
  };
  begin_piece(input.value(0.0));
  TwoPoles filter{start_value, start_value};
  const auto advance = [&](const Stretch& h, double until) {
    filter.advance(h, start_value + slope * (now - start),
                   slope * (until - now));
    now = until;
  };

  const Stretch interval = stretch(corner_, 1.0 / output_rate);
  std::vector<double> output(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double sample = static_cast<double>(k) / output_rate;
    bool whole = k > 0;
    for (; next < breaks.size() && breaks[next] < sample; whole = false) {
      advance(stretch(corner_, breaks[next] - now), breaks[next]);
      ++next;
      begin_piece(break_values[next - 1]);
    }
    advance(whole ? interval : stretch(corner_, sample - now), sample);
    output[k] = filter.second;
  }
  return output;
}

std::vector<double> OutputFilter::response(const SineSignal& input,
                                           double output_rate,
                                           std::size_t count) const {
  require_positive(output_rate, "output rate", "Hz");
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const std::complex<double> H = gain(kTurn * input.frequency);
  const double amplitude = input.amplitude * std::abs(H);
  const double phase = input.phase + std::arg(H);
  std::vector<double> output(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double turns =
        std::fmod(input.frequency * static_cast<double>(k) / output_rate, 1.0);
    output[k] = input.offset + amplitude * std::sin(kTurn * turns + phase);
  }
  return output;
}

}  // namespace beamgyro
