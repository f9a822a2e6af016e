// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// The zero-rate terms and the output of a split-mode gyro with the drive
/// locked, first order in every small quantity: (2.20)-(2.23). Written apart
/// from the exact solution, as an independent check of it.
struct ClosedForm {
  double split;           // Delta' [rad/s]
  double sense_decay;     // 1/tau_y [rad/s]
  double sense_phase;     // psi_y [rad]
  double in_phase;        // B_0 [rad/s]
  double quadrature;      // Q_0 [rad/s]
  double rate_amplitude;  // |r| per rate, A |Theta_R|/D times g [C/(rad/s)]
  double readout_phase;   // psi_y + phi_R - phi_F [rad]
};

/// `omega` is the drive frequency w_d [rad/s].
ClosedForm closed_form(const ModalParameters& modal, const DriveLoop& loop,
                       double feedthrough, double omega);

/// Zero-rate output at beam and board temperature T [rad/s], offset trimmed at
/// T_0, by (2.23).
double closed_form_output(const TrimmedGyro& gyro, double T);

}  // namespace beamgyro::internal
