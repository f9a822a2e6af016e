// SPDX-License-Identifier: MIT
#include "sim/dynamics/loop_noise.h"

#include <cmath>
#include <numbers>

#include "linear_algebra/linear_systems.h"
#include "sim/dynamics/complex_form.h"
#include "sim/dynamics/mechanical_noise.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2cd;

Eigen::Matrix<double, 2, 4> real_row(const Vector2cd& row) {
  Matrix2cd matrix = Matrix2cd::Zero();
  matrix.row(0) = row.transpose();
  return real_form(matrix).topRows<2>();
}

}  // namespace

Eigen::VectorXd settled_state(const TrimmedGyro& gyro, const EnvelopeOde& ode,
                              const CaseMotion& motion, double T_beam,
                              double T_board) {
  const ModalParameters modal = modal_at(gyro, T_beam);
  const StaticSolution s = static_solution(gyro, modal, motion);
  const LoopElectronics& loops = ode.loops();
  Eigen::VectorXd y = ode.at_rest(T_beam);
  y(kEnvelopeNodes + Index{kBoard}) = T_board;
  put(y, kAmplitude, s.amplitude(0) / gyro.device.drive.amplitude);
  put(y, kAmplitude + 2, s.amplitude(1) / gyro.device.drive.amplitude);
  for (Index i = 0; i < ode.spurious_modes(); ++i) {
    // (13.1) in its steady state, with sqrt(m) q_s of the unit's own mass.
    const SpuriousResonance& mode = modal.spurious[static_cast<std::size_t>(i)];
    const double w = s.drive_frequency;
    const Complex q = -(mode.coupling(0) * s.amplitude(0) +
                        mode.coupling(1) * s.amplitude(1)) /
                      Complex(mode.square - w * w, mode.width * w);
    put(y, ode.first_spurious() + 2 * i,
        q / (std::sqrt(modal.mass) * gyro.device.drive.amplitude));
  }
  Complex feedback(std::sin(loops.pll_phase), std::cos(loops.pll_phase));
  if (!s.amplitude_locked) {
    feedback *= std::abs(charge_of(modal.coupling[kFeedback], s.amplitude)) /
                loops.feedback_scale;
  }
  put(y, kFeedback1, feedback);
  put(y, kFeedback2, feedback);
  y(kPllIntegral) = s.drive_frequency - loops.nominal_frequency;
  y(kAgcIntegral) = s.drive_voltage / loops.nominal_voltage;
  const Complex z =
      s.signal / gyro.rate_axis * electronics_at(gyro, T_board).turn;
  if (loops.rebalance) {
    put(y, kRebalance, -z / loops.rebalance_integral);
  } else {
    put(y, kReadout1, z);
    put(y, kReadout2, z);
  }
  put(y, kOutput1, z);
  put(y, kOutput2, z);
  return y;
}

NoiseSystem loop_noise(const TrimmedGyro& gyro, EnvelopeOde& ode, double T_beam,
                       double T_board) {
  const LoopElectronics& loops = ode.loops();
  const Eigen::VectorXd y = settled_state(gyro, ode, {}, T_beam, T_board);
  MatrixXd slope(y.size(), y.size());
  ode.jacobian({.motion = {}, .surroundings = {T_beam}, .powered = true}, y,
               slope);
  const Index n = loops.rebalance ? kEnvelopeNodes : kRebalance;
  NoiseSystem system{slope.topLeftCorner(n, n), MatrixXd::Zero(n, 8)};

  ModalParameters modal = modal_at(gyro, T_beam);
  modal.spurious.clear();  // they are no part of this system
  const double w = loops.nominal_frequency + y(kPllIntegral);
  const NoiseDensities density = noise_densities(gyro.device, modal, T_beam, w);
  const BrownianInput force =
      brownian_input(density.force, modal.mass, modal.damping / modal.mass,
                     slope.topLeftCorner<4, 4>(), w);
  const double wf = loops.demodulator_corner;
  const Complex turn = electronics_at(gyro, T_board).turn;
  const Matrix2d conjugate = Eigen::Vector2d(1, -1).asDiagonal();
  auto brownian = system.B.leftCols<4>();
  brownian.middleRows<4>(kAmplitude) =
      force.input / gyro.device.drive.amplitude;
  brownian.middleRows<2>(kReadout1) =
      wf * real_row(modal.coupling[kReadout] * (turn / loops.charge_axis)) *
      force.direct;
  brownian.middleRows<2>(kFeedback1) =
      wf * conjugate *
      real_row(-modal.coupling[kFeedback] / loops.feedback_scale) *
      force.direct;

  const double charge = std::sqrt(density.dielectric + density.amplifier);
  system.B.block<2, 2>(kReadout1, 4) =
      wf * charge / std::abs(loops.charge_axis) * Matrix2d::Identity();
  system.B.block<2, 2>(kFeedback1, 6) =
      wf * charge / loops.feedback_scale * Matrix2d::Identity();
  return system;
}

Eigen::Matrix2Xd drive_channels(const LoopElectronics& loops) {
  const double i = std::sin(loops.pll_phase), q = std::cos(loops.pll_phase);
  const double V = loops.nominal_voltage, K = loops.agc_proportional;
  const Index n = loops.rebalance ? kEnvelopeNodes : kRebalance;
  Eigen::Matrix2Xd channels = Eigen::Matrix2Xd::Zero(2, n);
  channels.row(0).segment<2>(kFeedback2) << loops.pll_proportional * q,
      -loops.pll_proportional * i;
  channels(0, kPllIntegral) = 1;
  channels.row(0) /= 2 * std::numbers::pi;
  channels.row(1).segment<2>(kFeedback2) << -V * K * i, -V * K * q;
  channels(1, kAgcIntegral) = V;
  return channels;
}

Eigen::Vector2d drive_noise(const LoopElectronics& loops,
                            const NoiseSystem& system) {
  MatrixXd A = system.A;
  Eigen::Matrix2Xd channels = drive_channels(loops);
  // Nothing follows eta when the voltage stands at its limit.
  A(kAgcIntegral, kAgcIntegral) = 0;
  const bool limited = A.col(kAgcIntegral).isZero(0);
  A(kAgcIntegral, kAgcIntegral) =
      limited ? -1 : system.A(kAgcIntegral, kAgcIntegral);
  if (limited) channels.row(1).setZero();
  return (channels * solve_system(A, system.B)).rowwise().norm();
}

Eigen::Vector2d drive_noise_rms(const LoopElectronics& loops,
                                const NoiseSystem& system) {
  return (drive_channels(loops) * stationary_root(system)).rowwise().norm();
}

}  // namespace beamgyro::internal
