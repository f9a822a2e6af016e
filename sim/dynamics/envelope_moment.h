// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/loop_electronics.h"
#include "sim/dynamics/modal_table.h"

namespace beamgyro {

/// Couplings of a point of the modal table, or of its slope.
struct EnvelopeCouplings {
  Eigen::Vector2cd drive, damping;        // Theta/(m A_ref) [1/(s2 V)]
  Eigen::RowVector2cd feedback, readout;  // U to U_F, and to charge [C]
};

/// What the equations need of modal parameters, motion and board.
struct EnvelopeCoefficients {
  EnvelopeCouplings couplings;
  Eigen::Matrix2d stiffness, velocity;  // of EnvelopePlant
  Complex turn;                         // e^{i phi_el}
  double turn_slope;                    // d phi_el / dT_board [rad/K]
};

/// What a state says.
struct EnvelopeMoment {
  Eigen::Vector2cd U;
  double i1, q1, i2, q2;
  DriveSignals drive;
  double error_rate;      // e_A' [1/s]
  double voltage_rate;    // V_D' [V/s]
  Complex r1, r2, z;      // [rad/s]
  Complex V_B, V_B_rate;  // [V] [V/s]
  Eigen::Vector2cd force, force_rate;
};

/// Below, |i + jq| has no slope.
inline constexpr double kNoAmplitude = 1e-12;

}  // namespace beamgyro
