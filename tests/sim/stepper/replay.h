// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>
#include <variant>
#include <vector>

#include "sim/scenario/simulation.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro::internal {

inline const PiecewiseLinear& profile_of(const RateProfile& motion) {
  return std::get<PiecewiseLinear>(motion);
}

/// What a scenario of straight lines says at `t` [s], after any jump there or
/// before it.
inline StepInputs inputs_at(const ScenarioPlan& plan, double t, bool before) {
  StepInputs inputs;
  const auto value = [&](const PiecewiseLinear& profile) {
    return before ? profile.value_before(t) : profile.value(t);
  };
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    inputs.motion[i] = value(profile_of(plan.motion[i]));
  inputs.ambient = value(plan.ambient);
  return inputs;
}

inline StepperStart start_of(const ScenarioPlan& plan) {
  StepperStart start;
  start.seed = plan.seed;
  start.fidelity = plan.fidelity == Fidelity::kEnvelope
                       ? StepFidelity::kEnvelope
                       : StepFidelity::kQuasistatic;
  start.noise = plan.noise_enabled;
  start.noise_rate = plan.output_rate;
  start.stirred = plan.stirred;
  start.inputs = inputs_at(plan, 0, false);
  start.powered = powered_at(plan.powered, 0);
  if (plan.has_age) start.age = plan.age;
  start.history = plan.history;
  return start;
}

/// The times [s] at which a scenario has a sample or a corner, in order.
inline std::vector<double> corners_of(const ScenarioPlan& plan) {
  std::vector<double> times = sample_times(plan);
  const double last = times.back();
  const auto add = [&](const std::vector<Border>& borders) {
    for (const Border& border : borders)
      if (border.time > 0 && border.time < last) times.push_back(border.time);
  };
  for (const RateProfile& motion : plan.motion)
    add(profile_of(motion).borders());
  add(plan.ambient.borders());
  for (const PowerInterval& interval : plan.powered)
    add({{interval.on}, {interval.off}});
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Replays a scenario in steps that end at every sample and every corner. The
/// result has one sample for each of the run.
inline std::vector<StepSample> replayed(
    const ScenarioPlan& given,
    const std::shared_ptr<const StepperModel>& model) {
  const ScenarioPlan plan = with_aligned_borders(given);
  GyroStepper stepper(model, start_of(plan));
  std::vector<StepSample> samples = {stepper.now()};
  const std::vector<double> times = sample_times(plan);
  double now = 0;
  for (const double end : corners_of(plan)) {
    if (end == 0) continue;
    stepper.step(end - now, inputs_at(plan, now, false),
                 inputs_at(plan, end, true), powered_at(plan.powered, now));
    now = end;
    if (times[samples.size()] == end) samples.push_back(stepper.now());
  }
  return samples;
}

}  // namespace beamgyro::internal
