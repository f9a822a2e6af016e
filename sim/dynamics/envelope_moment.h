// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/loop_electronics.h"
#include "sim/dynamics/modal_table.h"

namespace beamgyro::internal {

/// The couplings at a point of the modal table, or their slopes over
/// temperature.
struct EnvelopeCouplings {
  Eigen::Vector2cd drive, damping;        // Theta/(m A_ref) [1/(s2 V)]
  Eigen::RowVector2cd feedback, readout;  // U to U_F, and to charge [C]
};

/// The coefficients of the envelope's equations at one beam temperature, motion
/// of the case and board temperature.
struct EnvelopeCoefficients {
  EnvelopeCouplings couplings;
  Eigen::Matrix2d stiffness, velocity;  // of EnvelopePlant
  Complex turn;                         // e^{i phi_el}
  double turn_slope;                    // d phi_el / dT_board [rad/K]
};

/// The physical quantities that a state of EnvelopeOde stands for.
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

/// Below this amplitude the slope of |i + jq| is taken as 0.
inline constexpr double kNoAmplitude = 1e-12;

}  // namespace beamgyro::internal
