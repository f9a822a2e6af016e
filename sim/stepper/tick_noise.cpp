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

}  // namespace

TickNoise::TickNoise(const TrimmedGyro& gyro, const StepperStart& start,
                     double rate)
    : rate_(rate),
      has_sensor_(gyro.device.temperature_sensor.noise > 0),
      has_channels_(gyro.device.loop_channels &&
                    gyro.device.loop_channels->noise),
      output_noise_(output_noise(gyro), rate, start.seed, start.device,
                    start.run, start.age),
      sensor_stream_(start.seed, start.device, start.run,
                     kTemperatureSensorStream),
      quadrature_stream_(start.seed, start.device, start.run,
                         kQuadratureNoiseStream),
      frequency_stream_(start.seed, start.device, start.run,
                        kDriveFrequencyNoiseStream),
      voltage_stream_(start.seed, start.device, start.run,
                      kDriveVoltageNoiseStream) {
  draw(1);
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
  drive_frequency_ = last(frequency_stream_);
  drive_voltage_ = last(voltage_stream_);
}

void TickNoise::advance_to(double t) {
  constexpr double kRounding = 1e-6;  // of a tick
  const double place = std::floor(t * rate_ * (1 + 1e-13) + kRounding);
  if (!(place < static_cast<double>(kMostTicks)))
    throw std::runtime_error(fmt::format(
        "the noise at {:g} Hz ends after {} numbers, before {:g} s; expected a "
        "lower rate of the noise",
        rate_, kMostTicks, t));
  const auto tick = static_cast<std::uint64_t>(place);
  if (tick <= tick_) return;
  draw(tick - tick_);
  tick_ = tick;
}

void TickNoise::archive(StateArchive& archive) {
  archive(output_noise_, sensor_stream_, quadrature_stream_, frequency_stream_,
          voltage_stream_, tick_, output_, sensor_, quadrature_,
          drive_frequency_, drive_voltage_);
}

}  // namespace beamgyro::internal
