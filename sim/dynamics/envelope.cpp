// SPDX-License-Identifier: MIT
#include "sim/dynamics/envelope.h"

#include "linear_algebra/linear_systems.h"
#include "sim/dynamics/complex_form.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;
using State = Eigen::Ref<const Eigen::VectorXd>;

}  // namespace

EnvelopePlant::EnvelopePlant(const Matrix2d& stiffness,
                             const Matrix2d& velocity, double omega)
    : omega_(omega), velocity_(velocity) {
  Matrix2cd P = velocity.cast<std::complex<double>>();
  P.diagonal().array() += 2.0 * kI * omega;
  r_ = inverse_of(P);
  s_.real() = stiffness;
  s_.imag() = omega * velocity;
  s_.diagonal().array() -= omega * omega;
  d_ = r_ * r_;
  b_ = r_ + d_ * s_ * r_;
  a_ = -b_ * s_;
}

EnvelopePlant::Slope EnvelopePlant::slope(const Matrix2cd& dP,
                                          const Matrix2cd& dS) const {
  const Matrix2cd dR = -r_ * dP * r_;
  Slope d;
  d.D = dR * r_ + r_ * dR;
  d.B = dR + d.D * s_ * r_ + d_ * dS * r_ + d_ * s_ * dR;
  d.A = -d.B * s_ - b_ * dS;
  return d;
}

EnvelopePlant::Slope EnvelopePlant::by_frequency() const {
  Matrix2cd dS = kI * velocity_.cast<std::complex<double>>();
  dS.diagonal().array() -= 2 * omega_;
  return slope(2.0 * kI * Matrix2cd::Identity(), dS);
}

EnvelopePlant::Slope EnvelopePlant::by(const Matrix2d& stiffness,
                                       const Matrix2d& velocity) const {
  const Matrix2cd dP = velocity.cast<std::complex<double>>();
  return slope(dP, stiffness.cast<std::complex<double>>() + kI * omega_ * dP);
}

Vector2cd EnvelopePlant::first_order_by_frequency(const Vector2cd& U,
                                                  const Vector2cd& v) const {
  const Vector2cd by_S =
      kI * (velocity_.cast<std::complex<double>>() * U) - 2 * omega_ * U;
  return -r_ * (2.0 * kI * v + by_S);
}

Vector2cd EnvelopePlant::first_order_by(const Matrix2d& stiffness,
                                        const Matrix2d& velocity,
                                        const Vector2cd& U,
                                        const Vector2cd& v) const {
  const Vector2cd by_S =
      stiffness.cast<std::complex<double>>() * U + kI * omega_ * (velocity * U);
  return -r_ * (velocity * v + by_S);
}

LoopedBeam::LoopedBeam(const TrimmedGyro& gyro)
    : loops_(loop_electronics(gyro)),
      table_(gyro),
      phase_tc_(gyro.device.readout.phase_tc),
      phase_tc2_(gyro.device.readout.phase_tc2),
      angular_gain_(gyro.beam.angular_gain),
      amplitude_(gyro.device.drive.amplitude),
      mass_amplitude_(gyro.beam.mass * gyro.device.drive.amplitude) {}

LoopedBeam::Couplings LoopedBeam::couplings(const ModalChannels& modal) const {
  const auto along = [&](Patch patch) -> Vector2cd {
    return coupling_of(modal, patch) *
           table_.direction()[patch].cast<Complex>();
  };
  const double to_feedback = -mass_amplitude_ / loops_.feedback_scale;
  return {along(kDrive) / amplitude_, along(kDamping) / amplitude_,
          along(kFeedback).transpose() * to_feedback,
          along(kReadout).transpose() * mass_amplitude_};
}

Complex LoopedBeam::turn(double board_temperature) const {
  const double dT = board_temperature - kCalibrationTemperature;
  return std::polar(1.0, (phase_tc_ + phase_tc2_ * dT) * dT);
}

void LoopedBeam::put_loop_rates(const DriveSignals& drive, Complex U_F,
                                Complex r, Complex z, const State& y,
                                Eigen::Ref<Eigen::VectorXd> dydt) const {
  const double wf = loops_.demodulator_corner, wo = loops_.output_corner;
  dydt(kFeedback1) = wf * (U_F.real() - y(kFeedback1));
  dydt(kFeedback1 + 1) = wf * (-U_F.imag() - y(kFeedback1 + 1));
  dydt(kFeedback2) = wf * (y(kFeedback1) - y(kFeedback2));
  dydt(kFeedback2 + 1) = wf * (y(kFeedback1 + 1) - y(kFeedback2 + 1));
  dydt(kPllIntegral) = loops_.pll_integral * drive.phase_error();
  dydt(kAgcIntegral) = drive.integral_rate;
  const Complex r1 = complex_at(y, kReadout1), r2 = complex_at(y, kReadout2);
  put(dydt, kReadout1, wf * (r - r1));
  put(dydt, kReadout2, wf * (r1 - r2));
  const Complex o1 = complex_at(y, kOutput1), o2 = complex_at(y, kOutput2);
  put(dydt, kOutput1, wo * (z - o1));
  put(dydt, kOutput2, wo * (o1 - o2));
  put(dydt, kRebalance, loops_.rebalance ? r2 : Complex(0));
}

EnvelopeOde::EnvelopeOde(const TrimmedGyro& gyro, const DriveHeating& heating,
                         const ModalMemory* memory)
    : LoopedBeam(gyro),
      spurious_(gyro),
      memory_(memory),
      thermal_(ThermalNetwork(gyro.device.thermal), heating.mechanical,
               heating.dielectric) {}

Eigen::VectorXd EnvelopeOde::at_rest(double temperature) const {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size());
  y.segment<kThermalNodeCount>(kEnvelopeNodes).setConstant(temperature);
  return y;
}

ModalTable::Point EnvelopeOde::modal_at(double time, double beam_temperature) {
  ModalTable::Point modal = table_.at(beam_temperature);
  if (memory_ != nullptr)
    modal.value += memory_->at(time, beam_temperature, memory_interval_);
  return modal;
}

SpuriousEnvelope EnvelopeOde::spurious_envelope(double time, const State& y,
                                                const EnvelopeMoment& m) {
  const double beam = y(kEnvelopeNodes + Eigen::Index{kBeam});
  const double housing = y(kEnvelopeNodes + Eigen::Index{kHousing});
  MemoryState memory;
  if (spurious_.have_memory() && memory_ != nullptr)
    memory = memory_->state(time, beam);
  SpuriousEnvelope::Amplitudes Z(spurious_.count());
  for (Eigen::Index i = 0; i < Z.size(); ++i)
    Z(i) = complex_at(y, first_spurious() + 2 * i);
  return {spurious_.at({beam, housing}, memory), m.drive.frequency, m.U, Z};
}

EnvelopeCoefficients EnvelopeOde::coefficients(const ModalChannels& modal,
                                               const CaseMotion& motion,
                                               double board_temperature) const {
  const auto [stiffness, velocity] = mode_forces(
      stiffness_of(modal), damping_of(modal), angular_gain_, motion);
  const double dT = board_temperature - kCalibrationTemperature;
  return {couplings(modal), stiffness, velocity, turn(board_temperature),
          phase_tc_ + 2 * phase_tc2_ * dT};
}

EnvelopeMoment EnvelopeOde::moment(const EnvelopeCoefficients& now,
                                   const State& y) const {
  EnvelopeMoment m{};
  m.U = {complex_at(y, kAmplitude), complex_at(y, kAmplitude + 2)};
  m.i1 = y(kFeedback1), m.q1 = y(kFeedback1 + 1);
  m.i2 = y(kFeedback2), m.q2 = y(kFeedback2 + 1);
  m.drive = drive_signals(loops_, m.i2, m.q2, y(kPllIntegral), y(kAgcIntegral));
  const double wf = loops_.demodulator_corner, a = m.drive.amplitude;
  m.error_rate = a > kNoAmplitude
                     ? -wf * (m.i2 * (m.i1 - m.i2) + m.q2 * (m.q1 - m.q2)) / a
                     : 0;
  m.voltage_rate = m.drive.limited
                       ? 0
                       : loops_.nominal_voltage *
                             (loops_.agc_proportional * m.error_rate +
                              loops_.agc_integral * m.drive.amplitude_error());
  m.r1 = complex_at(y, kReadout1);
  m.r2 = complex_at(y, kReadout2);
  m.force = now.couplings.drive * m.drive.voltage;
  m.force_rate = now.couplings.drive * m.voltage_rate;
  m.z = m.r2;
  if (loops_.rebalance) {
    const double integral = loops_.rebalance_integral;
    const Complex proportional = loops_.rebalance_proportional;
    const Complex axis = loops_.voltage_axis * std::conj(now.turn);
    m.z = -(integral * complex_at(y, kRebalance) + proportional * m.r2);
    m.V_B = axis * m.z;
    m.V_B_rate = -axis * (integral * m.r2 + proportional * wf * (m.r1 - m.r2));
    m.force += now.couplings.damping * m.V_B;
    m.force_rate += now.couplings.damping * m.V_B_rate;
  }
  return m;
}

void EnvelopeOde::rate(const EnvelopeInputs& inputs, const State& y,
                       Eigen::Ref<Eigen::VectorXd> dydt) {
  const auto nodes = y.segment(kEnvelopeNodes, thermal_.size());
  thermal_.rate(inputs.surroundings, inputs.powered, nodes,
                dydt.segment(kEnvelopeNodes, thermal_.size()));
  if (!inputs.powered) {
    dydt.head<kEnvelopeNodes>().setZero();
    dydt.tail(2 * spurious_.count()).setZero();
    return;
  }
  const EnvelopeCoefficients now = coefficients(
      modal_at(inputs.time, nodes(kBeam)).value, inputs.motion, nodes(kBoard));
  EnvelopeMoment m = moment(now, y);
  const EnvelopePlant plant(now.stiffness, now.velocity, m.drive.frequency);
  if (spurious_.count() > 0) {
    const SpuriousEnvelope spurious = spurious_envelope(inputs.time, y, m);
    m.force += spurious.force();
    m.force_rate += spurious.force_rate();
    const SpuriousEnvelope::Amplitudes rates =
        spurious.rates(plant.first_order(m.U, m.force));
    for (Eigen::Index i = 0; i < rates.size(); ++i)
      put(dydt, first_spurious() + 2 * i, rates(i));
  }
  const Vector2cd dU = plant.from_amplitude() * m.U +
                       plant.from_force() * m.force -
                       plant.from_force_rate() * m.force_rate;
  put(dydt, kAmplitude, dU(0));
  put(dydt, kAmplitude + 2, dU(1));
  const Complex U_F = now.couplings.feedback * m.U;
  const Complex charge = now.couplings.readout * m.U;
  const Complex r = (charge + loops_.feedthrough * m.drive.voltage) * now.turn /
                    loops_.charge_axis;
  put_loop_rates(m.drive, U_F, r, m.z, y, dydt);
}

Eigen::VectorXd envelope_error_weights(const TrimmedGyro& gyro,
                                       const EnvelopeOde& ode) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(ode.size());
  weights.segment<2>(kAmplitude).setConstant(0.3);
  weights.segment<2>(kAmplitude + 2).setConstant(2e-3);
  weights.segment<4>(kFeedback1).setConstant(0.3);
  weights(kPllIntegral) = 100;
  weights(kAgcIntegral) = 0.3;
  weights.tail(ode.size() - kEnvelopeNodes).setConstant(50);
  const Eigen::VectorXd spurious = spurious_error_weights(gyro);
  weights.tail(spurious.size()) = spurious;
  return weights;
}

}  // namespace beamgyro::internal
