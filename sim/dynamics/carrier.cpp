// SPDX-License-Identifier: MIT
#include "sim/dynamics/carrier.h"

#include <cmath>
#include <numbers>

#include "sim/dynamics/complex_form.h"
#include "sim/dynamics/envelope.h"

namespace beamgyro::internal {
namespace {

using Eigen::Vector2cd;
using Eigen::Vector2d;

}  // namespace

CarrierOde::CarrierOde(const Gyro& gyro)
    : loops_(loop_electronics(gyro)),
      table_(gyro),
      angular_gain_(gyro.beam.angular_gain),
      amplitude_(gyro.device.drive.amplitude),
      mass_amplitude_(gyro.beam.mass * gyro.device.drive.amplitude),
      phase_tc_(gyro.device.readout.phase_tc),
      phase_tc2_(gyro.device.readout.phase_tc2) {
  set_temperatures(kCalibrationTemperature, kCalibrationTemperature);
}

void CarrierOde::set_temperatures(double beam, double board,
                                  const ModalChannels& memory) {
  const ModalChannels modal = table_.at(beam).value + memory;
  stiffness_ = stiffness_of(modal);
  damping_ = damping_of(modal);
  const auto along = [&](Patch patch) -> Vector2cd {
    return coupling_of(modal, patch) *
           table_.direction()[patch].cast<Complex>();
  };
  drive_ = along(kDrive) / amplitude_;
  damping_patch_ = along(kDamping) / amplitude_;
  feedback_ =
      along(kFeedback).transpose() * (-mass_amplitude_ / loops_.feedback_scale);
  readout_ = along(kReadout).transpose() * mass_amplitude_;
  const double dT = board - kCalibrationTemperature;
  turn_ = std::polar(1.0, (phase_tc_ + phase_tc2_ * dT) * dT);
}

void CarrierOde::begin_window(double elapsed) {
  window_phase_ = std::remainder(
      window_phase_ + loops_.nominal_frequency * elapsed, 2 * std::numbers::pi);
}

void CarrierOde::rate(double t, const CaseMotion& motion,
                      const Eigen::Ref<const Eigen::VectorXd>& y,
                      Eigen::Ref<Eigen::VectorXd> dydt) const {
  const DriveSignals drive =
      drive_signals(loops_, y(kFeedback2), y(kFeedback2 + 1), y(kPllIntegral),
                    y(kAgcIntegral));
  const double w = loops_.nominal_frequency;
  const double theta = window_phase_ + w * t + y(kCarrierPhase);
  const Complex carrier(std::cos(theta), std::sin(theta));
  const Complex demodulator = 2.0 * std::conj(carrier);

  const Complex r1 = complex_at(y, kReadout1), r2 = complex_at(y, kReadout2);
  Complex z = r2;
  Vector2d force = (drive_ * (drive.voltage * carrier)).real();
  if (loops_.rebalance) {
    z = -(loops_.rebalance_integral * complex_at(y, kRebalance) +
          loops_.rebalance_proportional * r2);
    const Complex V_B = loops_.voltage_axis * std::conj(turn_) * z;
    force += (damping_patch_ * (V_B * carrier)).real();
  }
  const auto [position, velocity] =
      mode_forces(stiffness_, damping_, angular_gain_, motion);
  const Vector2d x = y.segment<2>(kPosition), v = y.segment<2>(kVelocity);
  dydt.segment<2>(kPosition) = w * v;
  dydt.segment<2>(kVelocity) =
      (force - (position + euler_force(angular_gain_, motion)) * x) / w -
      velocity * v;

  const double wf = loops_.demodulator_corner, wo = loops_.output_corner;
  const Complex U_F = demodulator * (feedback_(0) * x(0) + feedback_(1) * x(1));
  dydt(kFeedback1) = wf * (U_F.real() - y(kFeedback1));
  dydt(kFeedback1 + 1) = wf * (-U_F.imag() - y(kFeedback1 + 1));
  dydt(kFeedback2) = wf * (y(kFeedback1) - y(kFeedback2));
  dydt(kFeedback2 + 1) = wf * (y(kFeedback1 + 1) - y(kFeedback2 + 1));
  dydt(kPllIntegral) = loops_.pll_integral * drive.phase_error();
  dydt(kAgcIntegral) = drive.integral_rate;

  const Complex charge = readout_(0) * x(0) + readout_(1) * x(1) +
                         loops_.feedthrough * drive.voltage * carrier.real();
  const Complex r = demodulator * charge * turn_ / loops_.charge_axis;
  put(dydt, kReadout1, wf * (r - r1));
  put(dydt, kReadout2, wf * (r1 - r2));
  const Complex o1 = complex_at(y, kOutput1), o2 = complex_at(y, kOutput2);
  put(dydt, kOutput1, wo * (z - o1));
  put(dydt, kOutput2, wo * (o1 - o2));
  put(dydt, kRebalance, loops_.rebalance ? r2 : Complex(0));
  dydt(kCarrierPhase) = drive.frequency - w;
}

}  // namespace beamgyro::internal
