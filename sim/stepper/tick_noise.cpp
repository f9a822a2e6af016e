// SPDX-License-Identifier: MIT
#include "sim/stepper/tick_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "sim/dynamics/mechanical_noise.h"

namespace beamgyro::internal {
namespace {

// Numbers of a stream: a tick takes one of each.
constexpr std::uint64_t kMostTicks = std::uint64_t{1} << 32;

// The loops bring the noise of the sensing themselves.
NoiseParameters output_parameters(const StepperModel& model,
                                  const StepperStart& start) {
  return start.fidelity == StepFidelity::kEnvelope ? model.gyro.device.noise
                                                   : output_noise(model.gyro);
}

}  // namespace

TickNoise::TickNoise(const std::shared_ptr<const StepperModel>& model,
                     const StepperStart& start, double rate,
                     const NoiseConditions& conditions)
    : model_(model),
      rate_(rate),
      has_sensor_(model->gyro.device.temperature_sensor.noise > 0),
      has_channels_(model->gyro.device.loop_channels &&
                    model->gyro.device.loop_channels->noise),
      output_noise_(output_parameters(*model, start), rate, start.seed,
                    start.device, start.run, start.age),
      white_sigma_(std::sqrt(rate) *
                   output_parameters(*model, start).angle_random_walk),
      sensor_stream_(start.seed, start.device, start.run,
                     kTemperatureSensorStream),
      quadrature_stream_(start.seed, start.device, start.run,
                         kQuadratureNoiseStream),
      frequency_stream_(start.seed, start.device, start.run,
                        kDriveFrequencyNoiseStream),
      voltage_stream_(start.seed, start.device, start.run,
                      kDriveVoltageNoiseStream) {
  if (start.fidelity == StepFidelity::kEnvelope)
    loops_.emplace(model, start, rate);
  draw(1);
  if (loops_ && conditions.powered)
    loops_->advance(1, conditions.beam, conditions.board);
}

void TickNoise::draw(std::uint64_t ticks) {
  for (std::uint64_t left = ticks; left > 0;) {
    std::array<double, 1024> sum;
    const auto count = std::min<std::uint64_t>(left, sum.size());
    const auto taken = std::span(sum).first(count);
    std::ranges::fill(taken, 0.0);
    output_noise_.add_next(taken);
    output_ = taken.back();
    left -= count;
  }
  const auto last = [ticks](RandomStream& stream) {
    if (ticks > 1) stream.seek(stream.position() + ticks - 1);
    return stream.normal();
  };
  if (has_sensor_) sensor_ = last(sensor_stream_);
  if (!has_channels_) return;
  quadrature_ = last(quadrature_stream_);
  if (loops_) return;
  drive_frequency_ = last(frequency_stream_);
  drive_voltage_ = last(voltage_stream_);
}

std::uint64_t TickNoise::last_tick(double rate, double t) {
  constexpr double kRounding = 1e-6;  // of a tick
  const double place = std::floor(t * rate * (1 + 1e-13) + kRounding);
  if (!(place < static_cast<double>(kMostTicks)))
    throw std::runtime_error(fmt::format(
        "the noise at {:g} Hz ends after {} numbers, before {:g} s; expected a "
        "lower rate of the noise",
        rate, kMostTicks, t));
  return static_cast<std::uint64_t>(place);
}

void TickNoise::advance_to(double t, const NoiseConditions& conditions) {
  const std::uint64_t tick = last_tick(rate_, t);
  if (tick <= tick_) return;
  const std::uint64_t ticks = tick - tick_;
  if (loops_ && conditions.powered)
    loops_->advance(ticks, conditions.beam, conditions.board);
  draw(ticks);
  tick_ = tick;
}

void TickNoise::switch_power(double t, const NoiseConditions& after) {
  constexpr double kRounding = 1e-6;  // of a tick
  if (!loops_ || std::abs(t * rate_ - static_cast<double>(tick_)) > kRounding)
    return;
  if (after.powered)
    loops_->advance(1, after.beam, after.board);
  else
    loops_->undo();
}

double TickNoise::output() const {
  return loops_ ? output_ + loops_->output() : output_;
}

double TickNoise::quadrature() const {
  const double of_loops = loops_ ? loops_->quadrature() : 0;
  return has_channels_ ? of_loops + white_sigma_ * quadrature_ : of_loops;
}

Eigen::Vector2d TickNoise::drive(double beam, bool locked) const {
  if (!has_channels_) return Eigen::Vector2d::Zero();
  Eigen::Vector2d noise;
  if (loops_)
    noise = loops_->drive();
  else
    noise = std::sqrt(rate_) *
            model_->drive_noise->at(beam).cwiseProduct(
                Eigen::Vector2d(drive_frequency_, drive_voltage_));
  if (!locked) noise(1) = 0;
  return noise;
}

void TickNoise::archive(StateArchive& archive) {
  archive(output_noise_, sensor_stream_, quadrature_stream_, frequency_stream_,
          voltage_stream_, tick_, output_, sensor_, quadrature_,
          drive_frequency_, drive_voltage_);
  if (loops_) archive(*loops_);
}

}  // namespace beamgyro::internal
