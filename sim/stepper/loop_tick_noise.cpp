// SPDX-License-Identifier: MIT
#include "sim/stepper/loop_tick_noise.h"

#include <cmath>
#include <utility>

#include "sim/dynamics/loop_noise.h"

namespace beamgyro::internal {

LoopTickNoise::LoopTickNoise(std::shared_ptr<const StepperModel> model,
                             const StepperStart& start, double rate)
    : model_(std::move(model)),
      ode_(model_->gyro, drive_heating(model_->gyro)),
      channels_(drive_channels(ode_.loops())),
      interval_(1 / rate),
      stream_(start.seed, start.device, start.run, kMechanicalNoiseStream) {}

NoiseSystem LoopTickNoise::system(double beam, double board) {
  beam_ = beam;
  board_ = board;
  return loop_noise(model_->gyro, ode_, beam, board);
}

void LoopTickNoise::begin(double beam, double board) {
  noise_.emplace(system(beam, board), interval_, stream_);
}

void LoopTickNoise::advance(std::uint64_t ticks, double beam, double board) {
  if (ticks == 0) return;
  if (!noise_) {
    begin(beam, board);
    is_first_ = true;
    --ticks;
  } else if (std::abs(beam - beam_) > kNoiseRefresh ||
             std::abs(board - board_) > kNoiseRefresh) {
    noise_->refresh(system(beam, board));
  }
  if (ticks > 0) is_first_ = false;
  for (; ticks > 0; --ticks) noise_->advance();
}

void LoopTickNoise::undo() {
  if (is_first_)
    noise_.reset();
  else if (noise_)
    noise_->undo();
}

double LoopTickNoise::output() const {
  return noise_ ? noise_->state()(kOutput2) : 0;
}

double LoopTickNoise::quadrature() const {
  return noise_ ? -noise_->state()(kOutput2 + 1) : 0;
}

Eigen::Vector2d LoopTickNoise::drive() const {
  if (!noise_) return Eigen::Vector2d::Zero();
  return channels_ * noise_->state();
}

void LoopTickNoise::archive(StateArchive& archive) {
  bool has_begun = noise_.has_value();
  archive(has_begun, is_first_, beam_, board_);
  if (!has_begun) {
    noise_.reset();
    return;
  }
  if (archive.is_reading()) begin(beam_, board_);
  archive(*noise_);
}

}  // namespace beamgyro::internal
