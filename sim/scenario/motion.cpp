// SPDX-License-Identifier: MIT
#include "sim/scenario/motion.h"

#include <algorithm>
#include <numbers>

#include "random/random_stream.h"

namespace beamgyro::internal {
Motion::Motion(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
               const RunKey& key)
    : mount_(gyro.device.mount) {
  const auto realise = [&](const RateProfile& profile,
                           RandomPurpose purpose) -> Signal {
    if (const auto* sine = std::get_if<SineSignal>(&profile)) return *sine;
    if (const auto* random = std::get_if<RandomRate>(&profile)) {
      return realised(*random, scenario.duration, scenario.seed, key.device,
                      key.run, purpose);
    }
    return std::get<PiecewiseLinear>(profile);
  };
  for (std::size_t i = 0; i < kCaseAxisCount; ++i) {
    moves_[i] = moves(scenario.motion[i]);
    axes_[i] = realise(scenario.motion[i], kCaseAxes[i].purpose);
  }
}

bool Motion::has_other_axes() const {
  return std::find(moves_.begin() + kRateX, moves_.end(), true) != moves_.end();
}

std::vector<Border> Motion::borders() const {
  std::vector<Border> borders;
  for (const Signal& axis : axes_) {
    if (const auto* points = std::get_if<PiecewiseLinear>(&axis)) {
      const std::vector<Border> found = points->borders();
      borders.insert(borders.end(), found.begin(), found.end());
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
  PerAxis<AxisSegment> segments;
  std::ranges::transform(axes_, segments.begin(), of);
  return {start, segments, mount_};
}

void Motion::sample(RunSamples& samples) const {
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    if (i == kRateZ || moves_[i])
      samples.motion[i] = values_at(axes_[i], samples.time);
}

}  // namespace beamgyro::internal
