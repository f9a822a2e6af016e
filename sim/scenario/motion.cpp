// SPDX-License-Identifier: MIT
#include "sim/scenario/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

double value(const AxisSegment& s, double since, double t) {
  double v = s.a + s.b * since;
  if (s.amplitude != 0) v += s.amplitude * std::sin(s.omega * t + s.phase);
  return v;
}

double slope(const AxisSegment& s, double t) {
  if (s.amplitude == 0) return s.b;
  return s.b + s.amplitude * s.omega * std::cos(s.omega * t + s.phase);
}

bool moving(const AxisSegment& s) { return s.b != 0 || s.amplitude != 0; }

bool is_zero(const AxisSegment& s) { return s.a == 0 && !moving(s); }

}  // namespace

MotionSegment::MotionSegment(double start,
                             const std::array<AxisSegment, 3>& rate,
                             const std::array<AxisSegment, 3>& acceleration,
                             const MountParameters& mount)
    : start_(start),
      rate_(rate),
      acceleration_(acceleration),
      accelerated_(
          !std::all_of(acceleration.begin(), acceleration.end(), is_zero)),
      mount_(mount) {}

CaseMotion MotionSegment::at(double t) const {
  CaseMotion motion = at_rest(t);
  motion.z = value(rate_[2], t - start_, t);
  motion.z_acceleration = slope(rate_[2], t);
  return motion;
}

CaseMotion MotionSegment::at_rest(double t) const {
  CaseMotion motion;
  motion.x = value(rate_[0], t - start_, t);
  motion.y = value(rate_[1], t - start_, t);
  if (accelerated_) {
    std::array<double, 3> a{};
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] = value(acceleration_[i], t - start_, t);
    motion.in_phase = in_phase_rate(mount_, a);
  }
  return motion;
}

bool MotionSegment::is_constant() const {
  return std::none_of(rate_.begin(), rate_.end(), moving) &&
         std::none_of(acceleration_.begin(), acceleration_.end(), moving);
}

Motion::Motion(const ScenarioPlan& scenario, const Gyro& gyro,
               const RunKey& key)
    : rate_moves_(moves(scenario.rate)), mount_(gyro.device.mount) {
  const auto realise = [&](const RateProfile& profile,
                           RandomPurpose purpose) -> Signal {
    if (const auto* sine = std::get_if<SineSignal>(&profile)) return *sine;
    if (const auto* random = std::get_if<RandomRate>(&profile)) {
      return realised(*random, scenario.duration, scenario.seed, key.device,
                      key.run, purpose);
    }
    return std::get<PiecewiseLinear>(profile);
  };
  for (std::size_t i = 0; i < cross_moves_.size(); ++i) {
    cross_moves_[i] = moves(scenario.cross_rate[i]);
    rate_[i] = realise(scenario.cross_rate[i], kCrossPurposes[i]);
  }
  rate_[2] = realise(scenario.rate, kRateProfileStream);
  for (std::size_t i = 0; i < acceleration_.size(); ++i) {
    acceleration_moves_[i] = moves(scenario.acceleration[i]);
    acceleration_[i] =
        realise(scenario.acceleration[i], kAccelerationPurposes[i]);
  }
}

bool Motion::has_other_axes() const {
  const auto is_true = [](bool moved) { return moved; };
  return std::any_of(cross_moves_.begin(), cross_moves_.end(), is_true) ||
         std::any_of(acceleration_moves_.begin(), acceleration_moves_.end(),
                     is_true);
}

std::vector<Border> Motion::borders() const {
  std::vector<Border> borders;
  for (const auto* axes : {&rate_, &acceleration_}) {
    for (const Signal& axis : *axes) {
      if (const auto* points = std::get_if<PiecewiseLinear>(&axis)) {
        const std::vector<Border> found = points->borders();
        borders.insert(borders.end(), found.begin(), found.end());
      }
    }
  }
  return borders;
}

MotionSegment Motion::segment(double start, double end) const {
  const auto of = [&](const Signal& axis) -> AxisSegment {
    if (const auto* sine = std::get_if<SineSignal>(&axis)) {
      return {.a = sine->offset,
              .amplitude = sine->amplitude,
              .omega = 2 * std::numbers::pi * sine->frequency,
              .phase = sine->phase};
    }
    const LinearStretch line =
        std::get<PiecewiseLinear>(axis).stretch(start, end);
    return {.a = line.start_value,
            .b = (line.end_value - line.start_value) / (end - start)};
  };
  return {start,
          {of(rate_[0]), of(rate_[1]), of(rate_[2])},
          {of(acceleration_[0]), of(acceleration_[1]), of(acceleration_[2])},
          mount_};
}

void Motion::sample(RunSamples& samples) const {
  samples.rate = values_at(rate_[2], samples.time);
  for (std::size_t i = 0; i < cross_moves_.size(); ++i) {
    if (cross_moves_[i])
      samples.cross_rate[i] = values_at(rate_[i], samples.time);
  }
  for (std::size_t i = 0; i < acceleration_moves_.size(); ++i) {
    if (acceleration_moves_[i])
      samples.acceleration[i] = values_at(acceleration_[i], samples.time);
  }
}

}  // namespace beamgyro::internal
