// SPDX-License-Identifier: MIT
#include "sim/signal/output_filter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/signal/two_poles.h"

namespace beamgyro::internal {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;  // [rad]

void require_positive(double value, const char* name, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("{} is {} {}, must be above 0", name, value, unit));
}

// The filter under a profile, from sample to sample.
class ProfileResponse {
 public:
  ProfileResponse(const PiecewiseLinear& input, double corner,
                  double output_rate)
      : input_(&input),
        corner_(corner),
        output_rate_(output_rate),
        interval_(filter_stretch(corner, 1.0 / output_rate)) {
    const std::vector<double>& times = input.times();
    next_ = static_cast<std::size_t>(
        std::upper_bound(times.begin(), times.end(), 0.0) - times.begin());
    is_constant_ = next_ == times.size();
    begin_piece(input.value(0.0));
    filter_ = {start_value_, start_value_};
  }

  void operator()(std::span<double> output) {
    if (is_constant_) {
      std::fill(output.begin(), output.end(), start_value_);
      return;
    }
    const std::vector<double>& times = input_->times();
    for (double& value : output) {
      const double sample = static_cast<double>(sample_) / output_rate_;
      bool whole = sample_++ > 0;
      for (; next_ < times.size() && times[next_] < sample; whole = false) {
        advance(filter_stretch(corner_, times[next_] - now_), times[next_]);
        while (next_ + 1 < times.size() && times[next_ + 1] == now_) ++next_;
        ++next_;
        begin_piece(input_->values()[next_ - 1]);
      }
      advance(whole ? interval_ : filter_stretch(corner_, sample - now_),
              sample);
      value = filter_.second;
    }
  }

 private:
  // The piece from now to the next point.
  void begin_piece(double value) {
    start_ = now_;
    start_value_ = value;
    slope_ = next_ == input_->times().size()
                 ? 0.0
                 : (input_->values()[next_] - value) /
                       (input_->times()[next_] - now_);
  }

  void advance(const FilterStretch& h, double until) {
    filter_.advance(h, start_value_ + slope_ * (now_ - start_),
                    slope_ * (until - now_));
    now_ = until;
  }

  const PiecewiseLinear* input_;
  double corner_;           // [rad/s]
  double output_rate_;      // [Hz]
  FilterStretch interval_;  // between two samples
  std::size_t sample_ = 0;
  std::size_t next_ = 0;  // first point after now
  bool is_constant_ = false;
  double now_ = 0.0;                                      // [s]
  double start_ = 0.0, start_value_ = 0.0, slope_ = 0.0;  // of the piece
  TwoPoles filter_{};
};

// The filter under a sine that never started.
class SineResponse {
 public:
  SineResponse(const SineSignal& input, std::complex<double> gain,
               double output_rate)
      : offset_(input.offset),
        amplitude_(input.amplitude * std::abs(gain)),
        frequency_(input.frequency),
        phase_(input.phase + std::arg(gain)),
        output_rate_(output_rate) {}

  void operator()(std::span<double> output) {
    for (double& value : output) {
      const double turns = std::fmod(
          frequency_ * static_cast<double>(sample_++) / output_rate_, 1.0);
      value = offset_ + amplitude_ * std::sin(kTurn * turns + phase_);
    }
  }

 private:
  double offset_, amplitude_;
  double frequency_;    // [Hz]
  double phase_;        // [rad]
  double output_rate_;  // [Hz]
  std::size_t sample_ = 0;
};

}  // namespace

OutputFilter::OutputFilter(double corner) : corner_(corner) {
  require_positive(corner, "output filter corner", "rad/s");
}

std::complex<double> OutputFilter::gain(double omega) const {
  const std::complex<double> pole(1.0, omega / corner_);
  return 1.0 / (pole * pole);
}

SampleStream OutputFilter::responses(const Signal& input,
                                     double output_rate) const {
  require_positive(output_rate, "output rate", "Hz");
  if (const auto* sine = std::get_if<SineSignal>(&input))
    return SineResponse(*sine, gain(kTurn * sine->frequency), output_rate);
  return ProfileResponse(std::get<PiecewiseLinear>(input), corner_,
                         output_rate);
}

std::vector<double> OutputFilter::response(const Signal& input,
                                           double output_rate,
                                           std::size_t count) const {
  std::vector<double> output(count);
  responses(input, output_rate)(output);
  return output;
}

}  // namespace beamgyro::internal
