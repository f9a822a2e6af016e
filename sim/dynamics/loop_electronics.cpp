// SPDX-License-Identifier: MIT
#include "sim/dynamics/loop_electronics.h"

#include <algorithm>
#include <cmath>

namespace beamgyro::internal {
namespace {

// lam and H_0 of force rebalance at T_0 (2.5): the sense mode seen from V_B
// while the loops hold the drive mode.
void set_rebalance(const ModalParameters& modal, double omega,
                   LoopElectronics& loops) {
  const double m = modal.mass;
  const double split =
      (modal.stiffness(1, 1) / m - omega * omega) / (2 * omega);
  const Complex lam(modal.damping(1, 1) / (2 * m), -split);
  const Eigen::Matrix2cd S = dynamic_stiffness(modal, omega, {});
  loops.rebalance_proportional = loops.rebalance_integral / lam;
  loops.voltage_axis = loops.charge_axis;
  loops.charge_axis *=
      modal.coupling[kReadout](1) * modal.coupling[kDamping](1) / S(1, 1);
}

}  // namespace

LoopElectronics loop_electronics(const TrimmedGyro& gyro) {
  const ModalParameters modal = modal_at(gyro, kCalibrationTemperature);
  const StaticSolution solution = static_solution(gyro, modal, {});
  const DriveParameters& drive = gyro.device.drive;
  const ReadoutParameters& readout = gyro.device.readout;
  const double tau = 2 * modal.mass / modal.damping(0, 0);
  LoopElectronics loops{
      .nominal_frequency = solution.drive_frequency,
      .nominal_voltage = solution.drive_voltage,
      .voltage_limit = drive.voltage_limit,
      .feedback_scale = gyro.loop.feedback_amplitude,
      .demodulator_corner = drive.demodulator_corner,
      .pll_phase = drive.pll_phase,
      .pll_proportional = drive.pll_bandwidth,
      .pll_integral = drive.pll_integral_corner * drive.pll_integral_corner,
      .agc_proportional = tau * drive.agc_bandwidth,
      .agc_integral = tau * drive.agc_bandwidth * drive.agc_integral_corner,
      .agc_tracking = drive.agc_integral_corner,
      .rebalance = readout.mode == ReadoutMode::kForceRebalance,
      .rebalance_integral = readout.rebalance_bandwidth,
      .charge_axis = gyro.rate_axis,
      .feedthrough = readout.feedthrough,
      .output_corner = readout.corner_frequency,
  };
  if (loops.rebalance) set_rebalance(modal, solution.drive_frequency, loops);
  return loops;
}

Detection phase_detection(double amplitude) {
  constexpr double kWidth = kDetectionEnd - kDetectionStart;
  const double s = (amplitude - kDetectionStart) / kWidth;
  if (s <= 0) return {0, 0};
  if (s >= 1) return {1, 0};
  return {s * s * (3 - 2 * s), 6 * s * (1 - s) / kWidth};
}

DriveSignals drive_signals(const LoopElectronics& loops, double i2, double q2,
                           double xi, double eta) {
  DriveSignals s{};
  s.amplitude = std::hypot(i2, q2);
  s.detection = phase_detection(s.amplitude);
  if (s.detection.gain > 0) s.phase = std::atan2(i2, q2) - loops.pll_phase;
  s.frequency =
      loops.nominal_frequency + loops.pll_proportional * s.phase_error() + xi;
  const double wanted = loops.nominal_voltage *
                        (loops.agc_proportional * s.amplitude_error() + eta);
  s.voltage = std::clamp(wanted, -loops.voltage_limit, loops.voltage_limit);
  s.limited = s.voltage != wanted;
  s.integral_rate = loops.agc_integral * s.amplitude_error();
  if (s.limited) {
    s.integral_rate +=
        loops.agc_tracking * (s.voltage - wanted) / loops.nominal_voltage;
  }
  return s;
}

bool is_locked(const DriveSignals& drive) {
  return !drive.limited &&
         std::abs(drive.amplitude_error()) < kAmplitudeErrorLocked &&
         std::abs(drive.phase) < kPhaseErrorLocked;
}

}  // namespace beamgyro::internal
