// SPDX-License-Identifier: MIT
#include "sim/stepper/stepper_model.h"

#include <utility>

#include "config/units.h"
#include "sim/dynamics/spurious_bias.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

// Where gyros work. Beyond, the exact solution takes some microseconds.
constexpr double kColdest = kZeroCelsius - 50, kHottest = kZeroCelsius + 100;
constexpr double kFastest = 1.25;  // of the full scale

void add_map(StepperModel& model) {
  const TrimmedGyro& gyro = model.gyro;
  if (gyro.device.memory.any() || needs_exact_solution(gyro)) return;
  model.coldest = kColdest;
  model.hottest = kHottest;
  model.fastest = kFastest * gyro.device.readout.full_scale;
  try {
    model.map.emplace(gyro, kColdest, kHottest, model.fastest);
  } catch (const SimulationFailure&) {
    // The loop does not lock somewhere: a state that is visited says so itself.
  }
}

}  // namespace

std::shared_ptr<const StepperModel> stepper_model(TrimmedGyro gyro) {
  auto model = std::make_shared<StepperModel>();
  model->gyro = std::move(gyro);
  add_map(*model);
  const auto& channels = model->gyro.device.loop_channels;
  if (channels && channels->noise)
    model->drive_noise.emplace(model->gyro, kColdest, kHottest, 1.0);
  return model;
}

}  // namespace beamgyro::internal
