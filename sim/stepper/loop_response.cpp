// SPDX-License-Identifier: MIT
#include "sim/stepper/loop_response.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace beamgyro::internal {
namespace {

constexpr double kTolerance = 1e-8;  // of a step, in the output [rad/s]

ExplicitRkOptions options_of(const TrimmedGyro& gyro, const EnvelopeOde& ode) {
  ExplicitRkOptions options;
  options.table = RkTable::kDormandPrince;
  options.absolute_tolerance = kTolerance * envelope_error_weights(gyro, ode);
  return options;
}

PerAxis<AxisSegment> lines_of(const StepCourse& course) {
  PerAxis<AxisSegment> lines;
  for (std::size_t i = 0; i < kCaseAxisCount; ++i) {
    const double from = course.from.motion[i], to = course.to.motion[i];
    lines[i] = {.a = from, .b = (to - from) / course.duration};
  }
  return lines;
}

bool turns(const StepCourse& course) {
  return course.from.motion[kRateZ] != 0 || course.to.motion[kRateZ] != 0;
}

}  // namespace

void LoopResponse::State::archive(StateArchive& archive) {
  for (double& value : y) archive(value);
  archive(step, has_twin, twin_step);
  if (!has_twin) return;
  twin.resize(y.size());
  for (double& value : twin) archive(value);
}

LoopResponse::LoopResponse(std::shared_ptr<const StepperModel> model)
    : model_(std::move(model)),
      ode_(model_->gyro, drive_heating(model_->gyro)),
      stability_(rebalance_stability(model_->gyro)),
      integrator_(
          [this](double t, const auto& y, auto dydt) {
            const double share = (t - course_.start) / course_.duration;
            ode_.rate(
                {.motion = at_rest_ ? segment_->at_rest(t) : segment_->at(t),
                 .surroundings = {std::lerp(course_.from.ambient,
                                            course_.to.ambient, share),
                                  course_.stirred},
                 .powered = course_.powered,
                 .time = t},
                y, dydt);
          },
          0.0, ode_.at_rest(kCalibrationTemperature),
          options_of(model_->gyro, ode_)) {}

LoopResponse::State LoopResponse::at_rest(const NodeVector& nodes) const {
  State state{.y = ode_.at_rest(kCalibrationTemperature)};
  state.y.segment<kThermalNodeCount>(kEnvelopeNodes) = nodes;
  return state;
}

void LoopResponse::stop(State& state) const {
  const auto still = [&](Eigen::VectorXd& y) {
    y.head<kEnvelopeNodes>().setZero();
    y.tail(y.size() - kEnvelopeNodes - kThermalNodeCount).setZero();
  };
  still(state.y);
  state.step = state.twin_step = 0;
  if (state.has_twin) still(state.twin);
}

void LoopResponse::advance(State& state, const StepCourse& course) {
  if (!state.has_twin && turns(course)) {
    state.has_twin = true;
    state.twin = state.y;
    state.twin_step = state.step;
  }
  advance(state.y, state.step, course, false);
  if (state.has_twin) advance(state.twin, state.twin_step, course, true);
}

void LoopResponse::advance(Eigen::VectorXd& y, double& step,
                           const StepCourse& course, bool at_rest) {
  course_ = course;
  at_rest_ = at_rest;
  segment_.emplace(course.start, lines_of(course), model_->gyro.device.mount);
  integrator_.restart(course.start, y, step);
  y = integrator_.advance_to(course.start + course.duration);
  step = integrator_.next_step();
}

NodeVector LoopResponse::nodes(const State& state) {
  return state.y.segment<kThermalNodeCount>(kEnvelopeNodes);
}

StepSignals LoopResponse::at(double t, const State& state, bool powered) {
  const Eigen::VectorXd& y = state.y;
  const NodeVector now = nodes(state);
  const DriveSignals drive =
      drive_signals(ode_.loops(), y(kFeedback2), y(kFeedback2 + 1),
                    y(kPllIntegral), y(kAgcIntegral));
  const bool locked = is_locked(drive);
  if (stability_ && powered && locked)
    stability_->check(t, now(kBeam), now(kBoard));
  const double offset = electronics_at(model_->gyro, now(kBoard)).offset;
  const double output = y(kOutput2) + offset;
  return {.output = output,
          .quadrature = -y(kOutput2 + 1),
          .bias = state.has_twin ? state.twin(kOutput2) + offset : output,
          .drive_frequency = drive.frequency / (2 * std::numbers::pi),
          .drive_voltage = drive.voltage,
          .locked = locked};
}

}  // namespace beamgyro::internal
