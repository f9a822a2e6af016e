// SPDX-License-Identifier: MIT
#include "sim/dynamics/carrier.h"

#include <cmath>
#include <numbers>

#include "sim/dynamics/complex_form.h"

namespace beamgyro::internal {
namespace {

using Eigen::Vector2d;

}  // namespace

CarrierOde::CarrierOde(const TrimmedGyro& gyro)
    : LoopedBeam(gyro), spurious_(gyro) {
  set_temperatures(kCalibrationTemperature, kCalibrationTemperature);
}

void CarrierOde::set_temperatures(double beam, double board,
                                  const ModalChannels& memory) {
  const ModalChannels modal = table_.at(beam).value + memory;
  stiffness_ = stiffness_of(modal);
  damping_ = damping_of(modal);
  couplings_ = couplings(modal);
  turn_ = turn(board);
  set_spurious({beam, beam}, {});
}

void CarrierOde::set_spurious(const SpuriousTemperatures& temperatures,
                              const MemoryState& memory) {
  if (has_spurious_modes()) oscillators_ = spurious_.at(temperatures, memory);
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

  const Complex r2 = complex_at(y, kReadout2);
  Complex z = r2;
  Vector2d force = (couplings_.drive * (drive.voltage * carrier)).real();
  if (loops_.rebalance) {
    z = -(loops_.rebalance_integral * complex_at(y, kRebalance) +
          loops_.rebalance_proportional * r2);
    const Complex V_B = loops_.voltage_axis * std::conj(turn_) * z;
    force += (couplings_.damping * (V_B * carrier)).real();
  }
  const auto [position, velocity] =
      mode_forces(stiffness_, damping_, angular_gain_, motion);
  const Vector2d x = y.segment<2>(kPosition), v = y.segment<2>(kVelocity);
  Eigen::Index state = kCarrierStates;
  for (const SpuriousOscillator& mode : oscillators_) {
    const double q = y(state), q_rate = y(state + 1);
    force -= q * mode.coupling;
    dydt(state) = w * q_rate;
    dydt(state + 1) =
        -(mode.square * q + mode.coupling.dot(x)) / w - mode.width * q_rate;
    state += 2;
  }
  dydt.segment<2>(kPosition) = w * v;
  dydt.segment<2>(kVelocity) =
      (force - (position + euler_force(angular_gain_, motion)) * x) / w -
      velocity * v;

  const Complex U_F = demodulator * (couplings_.feedback(0) * x(0) +
                                     couplings_.feedback(1) * x(1));
  const Complex charge = couplings_.readout(0) * x(0) +
                         couplings_.readout(1) * x(1) +
                         loops_.feedthrough * drive.voltage * carrier.real();
  const Complex r = demodulator * charge * turn_ / loops_.charge_axis;
  put_loop_rates(drive, U_F, r, z, y, dydt);
  dydt(kCarrierPhase) = drive.frequency - w;
}

}  // namespace beamgyro::internal
