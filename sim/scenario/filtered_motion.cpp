// SPDX-License-Identifier: MIT
#include "sim/scenario/filtered_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "sim/signal/two_poles.h"

namespace beamgyro::internal {
namespace {

using Samples = std::vector<double>;

// Of a profile, from sample to sample.
class ProfileSquare {
 public:
  ProfileSquare(const PiecewiseLinear& profile, double corner,
                double output_rate)
      : profile_(&profile),
        output_rate_(output_rate),
        corner_(corner),
        value_(profile.value(0)),
        filter_{value_ * value_, value_ * value_} {
    const std::vector<double>& times = profile.times();
    next_ = static_cast<std::size_t>(
        std::upper_bound(times.begin(), times.end(), 0.0) - times.begin());
    find_slope();
  }

  void operator()(std::span<double> output) {
    const std::vector<double>& times = profile_->times();
    for (double& shown : output) {
      const double sample = static_cast<double>(sample_++) / output_rate_;
      for (; next_ < times.size() && times[next_] <= sample; find_slope()) {
        advance_to(times[next_]);
        start_ = now_;
        while (next_ + 1 < times.size() && times[next_ + 1] == now_) ++next_;
        value_ = profile_->values()[next_++];
      }
      advance_to(sample);
      shown = filter_.second;
    }
  }

 private:
  void find_slope() {
    slope_ = next_ == profile_->times().size()
                 ? 0
                 : (profile_->values()[next_] - value_) /
                       (profile_->times()[next_] - start_);
  }

  void advance_to(double end) {
    filter_.advance_square(corner_, value_ + slope_ * (now_ - start_), slope_,
                           end - now_);
    now_ = end;
  }

  const PiecewiseLinear* profile_;
  double output_rate_;  // [Hz]
  double corner_;       // [rad/s]
  std::size_t sample_ = 0;
  std::size_t next_ = 0;  // first point after now
  double now_ = 0;        // [s]
  // Of the piece: where it starts [s], its value there and its slope.
  double start_ = 0, value_, slope_ = 0;
  TwoPoles filter_;
};

// (o + A sin p)^2 = o^2 + A^2/2 + 2 o A sin p + A^2/2 sin(2 p - 90 deg)
std::array<Signal, 2> square_of(const SineSignal& sine) {
  const double o = sine.offset, A = sine.amplitude;
  return {SineSignal{.offset = o * o + A * A / 2,
                     .amplitude = 2 * o * A,
                     .frequency = sine.frequency,
                     .phase = sine.phase},
          SineSignal{.amplitude = A * A / 2,
                     .frequency = 2 * sine.frequency,
                     .phase = 2 * sine.phase - std::numbers::pi / 2}};
}

}  // namespace

SampleStream filtered_square_acceleration(std::span<const Signal> axes,
                                          double corner, double output_rate) {
  std::vector<SampleStream> parts;
  const OutputFilter filter(corner);
  for (const Signal& axis : axes) {
    if (!moves(axis)) continue;
    if (const auto* sine = std::get_if<SineSignal>(&axis)) {
      for (const Signal& part : square_of(*sine))
        parts.push_back(filter.responses(part, output_rate));
    } else {
      parts.push_back(
          ProfileSquare(std::get<PiecewiseLinear>(axis), corner, output_rate));
    }
  }
  return [parts = std::move(parts),
          part = Samples()](std::span<double> sum) mutable {
    std::fill(sum.begin(), sum.end(), 0.0);
    part.resize(sum.size());
    for (SampleStream& stream : parts) {
      stream(part);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
    }
  };
}

FilteredMotion::FilteredMotion(const TrimmedGyro& gyro, const Motion& motion,
                               double output_rate)
    : mount_(gyro.device.mount) {
  const double corner = gyro.device.readout.corner_frequency;
  const OutputFilter filter(corner);
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    axes_[i].filtered = filter.responses(motion.axes()[i], output_rate);
  square_.filtered = filtered_square_acceleration(
      std::span(motion.axes()).subspan(kAccelerationX), corner, output_rate);
}

void FilteredMotion::Filtered::next(std::size_t count) {
  values.resize(count);
  filtered(values);
}

void FilteredMotion::next(std::size_t count) {
  for (Filtered& axis : axes_) axis.next(count);
  square_.next(count);
}

CaseMotion FilteredMotion::at(std::size_t k) const {
  CaseMotion motion;
  motion.x = axes_[kRateX].values[k];
  motion.y = axes_[kRateY].values[k];
  motion.z = axes_[kRateZ].values[k];
  motion.in_phase = in_phase_rate(
      mount_,
      {axes_[kAccelerationX].values[k], axes_[kAccelerationY].values[k],
       axes_[kAccelerationZ].values[k]},
      square_.values[k]);
  return motion;
}

}  // namespace beamgyro::internal
