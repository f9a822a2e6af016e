// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/envelope.h"

namespace beamgyro::internal {

/// Indices of the state vector of CarrierOde. Those of the electronics are as
/// in EnvelopeState. Positions are divided by A_ref, velocities by w_nom A_ref,
/// those of spurious modes also by sqrt(m).
enum CarrierState {
  kPosition = 0,       // x, y
  kVelocity = 2,       // x', y'
  kCarrierPhase = 20,  // theta - w_nom t [rad]
  kCarrierStates = 21  // then q_s, q_s' of each spurious mode
};

/// The differential equation of the carrier run: the two modes as they vibrate
/// (2.1), with every term, spurious modes (13.1), and the loops of
/// loop_electronics.h, which act on the vibration itself. Forces are Re[Theta_p
/// V_p e^{i theta}]. Demodulation multiplies by 2 e^{-i theta}, so its ripple
/// at twice the carrier is included. Temperatures are those of the last
/// set_temperatures(). Time counts from the last begin_window(), which keeps
/// the phase exact over hours. Not safe for use by two threads at once.
class CarrierOde : public LoopedBeam {
 public:
  explicit CarrierOde(const TrimmedGyro& gyro);

  /// [K]; `memory` is what a unit with memory adds to its coefficients. The
  /// housing is as warm as the beam, and spurious modes have no memory.
  void set_temperatures(double beam, double board,
                        const ModalChannels& memory = ModalChannels::Zero());
  /// Sets those of the spurious modes, after set_temperatures().
  void set_spurious(const SpuriousTemperatures& temperatures,
                    const MemoryState& memory);

  /// Starts a new window of time at `elapsed` [s] of the present one. A state
  /// vector at that time stays valid as the state at time 0 of the new window.
  void begin_window(double elapsed);

  Eigen::Index size() const { return kCarrierStates + 2 * spurious_.count(); }
  Eigen::VectorXd at_rest() const { return Eigen::VectorXd::Zero(size()); }
  bool has_spurious_modes() const { return spurious_.count() > 0; }

  /// Writes dy/dt at time `t` [s] of the window to `dydt`.
  void rate(double t, const CaseMotion& motion,
            const Eigen::Ref<const Eigen::VectorXd>& y,
            Eigen::Ref<Eigen::VectorXd> dydt) const;

 private:
  SpuriousOscillators spurious_;
  double window_phase_ = 0;  // theta - residual at time 0 of the window [rad]

  // At the temperatures set last.
  Eigen::Matrix2d stiffness_, damping_;  // per mass
  Couplings couplings_;
  Complex turn_;
  std::vector<SpuriousOscillator> oscillators_;
};

}  // namespace beamgyro::internal
