// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "sim/dynamics/carrier.h"
#include "sim/dynamics/loop_noise.h"
#include "sim/numerics/ode.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal {

inline Complex complex_at(const Eigen::VectorXd& y, Eigen::Index i) {
  return {y(i), y(i + 1)};
}

// The unconjugated product Theta_p^T u.
inline Complex charge_on(const ModalParameters& modal, Patch patch,
                         const Eigen::Vector2cd& u) {
  return modal.coupling[patch].transpose() * u;
}

// One unit with its carrier at two temperatures [K] and in one motion.
struct CarrierUnit {
  TrimmedGyro gyro;
  double T_beam, T_board;
  CaseMotion motion;
  CarrierOde ode{gyro};
  ModalParameters modal{modal_at(gyro, T_beam)};

  explicit CarrierUnit(const DeviceParameters& device,
                       double beam = kCalibrationTemperature,
                       double board = kCalibrationTemperature,
                       const CaseMotion& moving = {})
      : gyro(make_gyro(device)), T_beam(beam), T_board(board), motion(moving) {
    ode.set_temperatures(T_beam, T_board);
  }

  double reference() const { return gyro.device.drive.amplitude; }  // A_ref [m]
  StaticSolution solution() const {
    return static_solution(modal, gyro.loop, gyro.device.readout.feedthrough,
                           motion);
  }

  // `adjust` may change dy/dt.
  ExplicitRk from(
      const Eigen::VectorXd& start,
      std::function<void(Eigen::Ref<Eigen::VectorXd>)> adjust = {}) {
    ExplicitRkOptions options;
    options.absolute_tolerance.setConstant(1e-10);
    return ExplicitRk(
        [this, adjust = std::move(adjust)](double t, const auto& y, auto dydt) {
          ode.rate(t, motion, y, dydt);
          if (adjust) adjust(dydt);
        },
        0, start, options);
  }

  // What the envelope says of the carrier at its fixed point, at time 0: the
  // ripple at twice the carrier is missing.
  Eigen::VectorXd settled() const {
    const EnvelopeOde envelope(gyro, {0, 0});
    const Eigen::VectorXd known =
        settled_state(gyro, envelope, motion, T_beam, T_board);
    Eigen::VectorXd y = ode.at_rest();
    y.segment(kFeedback1, kEnvelopeNodes - kFeedback1) =
        known.segment(kFeedback1, kEnvelopeNodes - kFeedback1);
    put_vibration(complex_at(known, 0), complex_at(known, 2),
                  solution().drive_frequency, y);
    for (Eigen::Index i = kCarrierStates; i < y.size(); i += 2) {
      const Complex Z =
          complex_at(known, envelope.first_spurious() + i - kCarrierStates);
      const double w = solution().drive_frequency;
      y(i) = Z.real();
      y(i + 1) = -Z.imag() * w / ode.loops().nominal_frequency;
    }
    return y;
  }

  void put_vibration(Complex X, Complex Y, double frequency,
                     Eigen::VectorXd& y) const {
    const Complex to_velocity(0, frequency / ode.loops().nominal_frequency);
    y(kPosition) = X.real();
    y(kPosition + 1) = Y.real();
    y(kVelocity) = (to_velocity * X).real();
    y(kVelocity + 1) = (to_velocity * Y).real();
  }
};

// Mean of the state over one cycle of the carrier: free of what ripples at its
// multiples up to the eighth.
inline Eigen::VectorXd mean_over_cycle(ExplicitRk& rk, double frequency) {
  constexpr int kPoints = 9;
  const double start = rk.time(), cycle = 2 * std::numbers::pi / frequency;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(rk.state().size());
  for (int k = 0; k < kPoints; ++k)
    mean += rk.advance_to(start + k * cycle / kPoints) / kPoints;
  return mean;
}

}  // namespace beamgyro::internal
