// SPDX-License-Identifier: MIT
#include "sim/dynamics/gyro.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

constexpr double kPathStep = 1;  // [K], of LockPath

StaticSolution lock_near(const TrimmedGyro& gyro, const ModalParameters& modal,
                         const CaseMotion& motion, double guess) {
  return static_solution(modal, gyro.loop, gyro.device.readout.feedthrough,
                         motion, guess);
}

// The frequency of the lock nearest to `guess`, or 0 where there is none.
double frequency_near(const TrimmedGyro& gyro, const ModalParameters& modal,
                      double guess) {
  try {
    return lock_near(gyro, modal, {}, guess).drive_frequency;
  } catch (const SimulationFailure&) {
    return 0;
  }
}

// The lock at `to` [K] that continues `frequency` at `from`, or 0. Two locks
// are half widths apart; what moves by less in one step is the same one.
double followed(const TrimmedGyro& gyro, double from, double frequency,
                double to) {
  constexpr double kSmallestStep = 1e-3;  // [K]
  if (frequency == 0 || from == to) return frequency;
  const ModalParameters modal = modal_at(gyro, to);
  const double reached = frequency_near(gyro, modal, frequency);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  if (std::abs(reached - frequency) < 0.5 * half_width) return reached;
  if (std::abs(to - from) < kSmallestStep) return 0;
  const double middle = 0.5 * (from + to);
  return followed(gyro, middle, followed(gyro, from, frequency, middle), to);
}

Complex signal(const TrimmedGyro& gyro, const ModalParameters& modal,
               const CaseMotion& motion) {
  return static_solution(gyro, modal, motion).signal;
}

TrimmedGyro untrimmed_two_modes(const DeviceParameters& device) {
  TrimmedGyro gyro;
  gyro.device = device;
  gyro.beam = project_beam(device);
  const Eigen::Vector2cd feedback =
      patch_coupling(device, gyro.beam, kFeedback, kCalibrationTemperature);
  gyro.loop = {std::abs(feedback(0)) * device.drive.amplitude,
               device.drive.pll_phase, device.drive.voltage_limit,
               device.readout.mode};
  return gyro;
}

// The quadrature is linear in k_trim up to the shift of w_d: a secant from the
// closed-form slope 1/(2 m g w_d) of (2.22) converges in two or three steps.
double trimmed_stiffness(const TrimmedGyro& gyro) {
  constexpr int kMaxIterations = 20;
  constexpr double kTolerance = 1e-9;  // [rad/s], 6e-8 deg/s
  const double target = gyro.device.readout.quadrature_trim;
  ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
  const double omega = std::sqrt(modal.stiffness(0, 0) / modal.mass);
  const double slope = 1 / (2 * modal.coriolis_mass * omega);
  const double untrimmed = modal.stiffness(0, 1);
  double trim = 0;
  for (int i = 0; i < kMaxIterations; ++i) {
    modal.stiffness(0, 1) = modal.stiffness(1, 0) = untrimmed + trim;
    const double error = -zero_rate_terms(gyro, modal).imag() - target;
    if (std::abs(error) <= kTolerance) return trim;
    trim -= error / slope;
  }
  throw SimulationFailure(
      fmt::format("quadrature trim: no stiffness trim brings the quadrature to "
                  "{:.3f} rad/s",
                  target));
}

// Near the crossing a mode changes the loss of the drive mode by e_x^2 Q_x/eta
// of itself, and the slope of its phase over frequency by (e_x/eta)^2. What
// changes them by more bends the phase back, so that it has several zeros.
void require_one_lock(const SpuriousModeParameters& mode, double Q_x) {
  constexpr double kMostLoss = 0.3;
  const double e = mode.coupling_drive, eta = mode.loss_factor;
  const double loss = e * e * Q_x / eta;
  if (loss < kMostLoss && std::abs(e) < eta) return;
  throw SimulationFailure(fmt::format(
      "spurious_mode.{}.coupling_drive: {} makes the phase lock ambiguous "
      "where "
      "the mode crosses the drive frequency: e_x^2 Q_x/eta_s = {:.3g} (Q_x = "
      "{:.0f}), |e_x|/eta_s = {:.3g}; expected below {} and 1, so a magnitude "
      "below {:.3g}",
      mode.name, e, loss, Q_x, std::abs(e) / eta, kMostLoss,
      std::min(std::sqrt(kMostLoss * eta / Q_x), eta)));
}

TrimmedGyro untrimmed_gyro(const DeviceParameters& device) {
  TrimmedGyro gyro = untrimmed_two_modes(device);
  if (device.spurious_modes.empty()) return gyro;
  TrimmedGyro without = gyro;
  without.device.spurious_modes.clear();
  without.stiffness_trim = trimmed_stiffness(without);
  const ModalParameters modal = modal_at(without, kCalibrationTemperature);
  gyro.spurious_reference = static_solution(without, modal, {}).drive_frequency;
  const double Q_x = gyro.spurious_reference * modal.mass / modal.damping(0, 0);
  for (const SpuriousModeParameters& mode : device.spurious_modes)
    require_one_lock(mode, Q_x);
  return gyro;
}

// The modulator's reference is the drive mode's velocity: V_B per rate is
// 2 i w_d m_g X / Theta_By (2.5). Taken there, and not from dV_B/dOmega, the
// quadrature does not leak into the bias by the products of two misalignments.
Complex rebalance_reference(const TrimmedGyro& gyro,
                            const ModalParameters& modal) {
  const StaticSolution s = static_solution(gyro, modal, {});
  return Complex(0, 1) * s.amplitude(0) / modal.coupling[kDamping](1);
}

// Sets the trims and references of an untrimmed unit.
TrimmedGyro trimmed(TrimmedGyro gyro) {
  const ReadoutParameters& readout = gyro.device.readout;
  gyro.stiffness_trim = trimmed_stiffness(gyro);
  const ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
  gyro.rate_axis = rate_response(gyro, modal);
  if (gyro.loop.mode == ReadoutMode::kForceRebalance) {
    gyro.rate_axis = std::polar(std::abs(gyro.rate_axis),
                                std::arg(rebalance_reference(gyro, modal)));
  }
  gyro.rate_axis /= 1 + readout.scale_factor_error;
  gyro.offset =
      readout.offset_trim - beam_signal(gyro, modal, {}).demodulated.real();
  return gyro;
}

}  // namespace

double LockPath::at(const TrimmedGyro& gyro, double T) {
  const bool is_colder = T < kCalibrationTemperature;
  std::vector<double>& path = is_colder ? colder_ : warmer_;
  const auto temperature = [&](std::size_t k) {
    return kCalibrationTemperature +
           (is_colder ? -kPathStep : kPathStep) * static_cast<double>(k);
  };
  if (path.empty()) {
    const ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
    path.push_back(lock_near(gyro, modal, {}, 0).drive_frequency);
  }
  const auto last = static_cast<std::size_t>(
      std::abs(T - kCalibrationTemperature) / kPathStep);
  while (path.size() <= last) {
    const std::size_t k = path.size();
    path.push_back(
        followed(gyro, temperature(k - 1), path.back(), temperature(k)));
  }
  return followed(gyro, temperature(last), path[last], T);
}

StaticSolution static_solution(const TrimmedGyro& gyro,
                               const ModalParameters& modal,
                               const CaseMotion& motion, LockPath& path,
                               double guess) {
  const StaticSolution solution = lock_near(gyro, modal, motion, guess);
  const bool is_clear = solution.only_lock || guess > 0 ||
                        modal.temperature == kCalibrationTemperature;
  if (is_clear) return solution;
  const double continued = path.at(gyro, modal.temperature);
  return continued > 0 ? lock_near(gyro, modal, motion, continued) : solution;
}

StaticSolution static_solution(const TrimmedGyro& gyro,
                               const ModalParameters& modal,
                               const CaseMotion& motion, double guess) {
  LockPath path;
  return static_solution(gyro, modal, motion, path, guess);
}

ModalParameters modal_at(const TrimmedGyro& gyro, double T,
                         const MemoryState& memory) {
  return modal_at(gyro, SpuriousTemperatures{T, T}, memory);
}

ModalParameters modal_at(const TrimmedGyro& gyro,
                         const SpuriousTemperatures& temperatures,
                         const MemoryState& memory) {
  ModalParameters modal = modal_parameters(
      gyro.device, gyro.beam, temperatures.beam, gyro.stiffness_trim, memory);
  add_spurious_modes(gyro, temperatures, memory, modal);
  return modal;
}

void add_spurious_modes(const TrimmedGyro& gyro,
                        const SpuriousTemperatures& temperatures,
                        const MemoryState& memory, ModalParameters& modal) {
  if (gyro.spurious_reference == 0) return;
  modal.spurious =
      spurious_resonances(gyro.device.spurious_modes, gyro.spurious_reference,
                          gyro.beam.mass, temperatures, memory);
}

Complex rate_response(const TrimmedGyro& gyro, const ModalParameters& modal) {
  constexpr double kStep = 0.1;  // [rad/s]; cubic term 1e-8 of the slope
  const auto at = [&](double z) {
    CaseMotion motion;
    motion.z = z;
    return signal(gyro, modal, motion);
  };
  return (at(kStep) - at(-kStep)) / (2 * kStep);
}

Complex zero_rate_terms(const TrimmedGyro& gyro, const ModalParameters& modal) {
  return signal(gyro, modal, {}) / rate_response(gyro, modal);
}

TrimmedGyro make_gyro(const DeviceParameters& device) {
  TrimmedGyro gyro = untrimmed_gyro(device);
  require_passive_memory(device, gyro.beam);
  return trimmed(std::move(gyro));
}

TrimmedGyro without_spurious_modes(const TrimmedGyro& gyro) {
  TrimmedGyro without = gyro;
  without.device.spurious_modes.clear();
  without.spurious_reference = 0;
  without.stiffness_trim = 0;
  return trimmed(std::move(without));
}

double built_quadrature(const DeviceParameters& device, double stiffness_trim) {
  TrimmedGyro gyro = untrimmed_gyro(device);
  gyro.stiffness_trim = stiffness_trim;
  return -zero_rate_terms(gyro, modal_at(gyro, kCalibrationTemperature)).imag();
}

BeamSignal beam_signal(const TrimmedGyro& gyro, double T,
                       const CaseMotion& motion) {
  return beam_signal(gyro, modal_at(gyro, T), motion);
}

BeamSignal beam_signal(const TrimmedGyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion) {
  LockPath path;
  return beam_signal(gyro, modal, motion, path);
}

BeamSignal beam_signal(const TrimmedGyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion, LockPath& path, double guess) {
  const StaticSolution solution =
      static_solution(gyro, modal, motion, path, guess);
  return {solution.signal / gyro.rate_axis, solution.drive_frequency,
          solution.drive_voltage, solution.amplitude_locked};
}

DriveHeating drive_heating(const TrimmedGyro& gyro) {
  const ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
  const BeamSignal signal = beam_signal(gyro, modal, {});
  const double w = signal.drive_frequency, V = signal.drive_voltage;
  const double velocity = w * gyro.device.drive.amplitude;
  const double C =
      patch_capacitance(gyro.device.patches, kCalibrationTemperature);
  return {0.5 * modal.damping(0, 0) * velocity * velocity,
          0.5 * w * C * V * V * gyro.device.patches.loss_tangent};
}

double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a) {
  return in_phase_rate(mount, a, a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a, double square) {
  const std::array<double, 3>& b = mount.g_sensitivity;
  return b[0] * a[0] + b[1] * a[1] + b[2] * a[2] + mount.rectification * square;
}

double rate_slope(const TrimmedGyro& gyro, const ModalParameters& modal,
                  double T) {
  const Complex slope = rate_response(gyro, modal) / gyro.rate_axis;
  return (slope * electronics_at(gyro, T).turn).real() /
         (1 + gyro.device.readout.scale_factor_error);
}

Electronics electronics_at(const TrimmedGyro& gyro, double board_temperature) {
  const ReadoutParameters& readout = gyro.device.readout;
  const double dT = board_temperature - kCalibrationTemperature;
  return {std::polar(1.0, (readout.phase_tc + readout.phase_tc2 * dT) * dT),
          gyro.offset + (readout.offset_tc + readout.offset_tc2 * dT) * dT};
}

}  // namespace beamgyro::internal
