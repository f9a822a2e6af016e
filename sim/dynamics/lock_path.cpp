// SPDX-License-Identifier: MIT
#include "sim/dynamics/lock_path.h"

#include <cmath>

#include "sim/dynamics/gyro.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

constexpr double kStep = 1;             // [K]
constexpr double kSmallestStep = 1e-3;  // [K]

StaticSolution lock_near(const Gyro& gyro, const ModalParameters& modal,
                         const CaseMotion& motion, double guess) {
  return static_solution(modal, gyro.loop, gyro.device.readout.feedthrough,
                         motion, guess);
}

// The frequency of the lock nearest to `guess`, or 0 where there is none.
double frequency_near(const Gyro& gyro, const ModalParameters& modal,
                      double guess) {
  try {
    return lock_near(gyro, modal, {}, guess).drive_frequency;
  } catch (const SimulationFailure&) {
    return 0;
  }
}

// The lock at `to` [K] that continues `frequency` at `from`, or 0. Two locks
// are half widths apart; what moves by less in one step is the same one.
double followed(const Gyro& gyro, double from, double frequency, double to) {
  if (frequency == 0 || from == to) return frequency;
  const ModalParameters modal = modal_at(gyro, to);
  const double reached = frequency_near(gyro, modal, frequency);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  if (std::abs(reached - frequency) < 0.5 * half_width) return reached;
  if (std::abs(to - from) < kSmallestStep) return 0;
  const double middle = 0.5 * (from + to);
  return followed(gyro, middle, followed(gyro, from, frequency, middle), to);
}

}  // namespace

double LockPath::at(const Gyro& gyro, double T) {
  const bool is_colder = T < kCalibrationTemperature;
  std::vector<double>& path = is_colder ? colder_ : warmer_;
  const auto temperature = [&](std::size_t k) {
    return kCalibrationTemperature +
           (is_colder ? -kStep : kStep) * static_cast<double>(k);
  };
  if (path.empty()) {
    const ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
    path.push_back(lock_near(gyro, modal, {}, 0).drive_frequency);
  }
  const auto last =
      static_cast<std::size_t>(std::abs(T - kCalibrationTemperature) / kStep);
  while (path.size() <= last) {
    const std::size_t k = path.size();
    path.push_back(
        followed(gyro, temperature(k - 1), path.back(), temperature(k)));
  }
  return followed(gyro, temperature(last), path[last], T);
}

StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, LockPath& path,
                               double guess) {
  const StaticSolution solution = lock_near(gyro, modal, motion, guess);
  const bool is_clear = solution.only_lock || guess > 0 ||
                        modal.temperature == kCalibrationTemperature;
  if (is_clear) return solution;
  const double continued = path.at(gyro, modal.temperature);
  return continued > 0 ? lock_near(gyro, modal, motion, continued) : solution;
}

StaticSolution static_solution(const Gyro& gyro, const ModalParameters& modal,
                               const CaseMotion& motion, double guess) {
  LockPath path;
  return static_solution(gyro, modal, motion, path, guess);
}

}  // namespace beamgyro::internal
