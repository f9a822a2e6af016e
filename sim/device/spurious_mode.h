// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>
#include <span>
#include <vector>

#include "sim/device/device.h"

namespace beamgyro::internal {

/// A spurious mode at one temperature, for every frequency w:
///
///   q_s'' + width q_s' + square q_s + coupling^T (x, y) = 0,
///   force on (x, y) = -coupling q_s                                  (13.1)
struct SpuriousResonance {
  double square;             // w_s^2 [1/s2]
  double width;              // eta_s w_s [1/s]
  Eigen::Vector2d coupling;  // w_0^2 sqrt(m) (e_x, e_y) [sqrt(kg)/s2]
};

/// Temperatures that the modes of one unit follow [K].
struct SpuriousTemperatures {
  double beam, housing;
};

/// Returns the modes at one moment (13.2). `reference` is w_0 [rad/s], `mass`
/// the modal mass m [kg].
std::vector<SpuriousResonance> spurious_resonances(
    std::span<const SpuriousModeParameters> modes, double reference,
    double mass, const SpuriousTemperatures& temperatures,
    const MemoryState& memory = {});

/// What spurious modes add to the complex stiffness (13.3) and its derivative:
///   dK = -sum_s coupling coupling^T / (square + i width w - w^2).
struct SpuriousStiffness {
  Eigen::Matrix2cd value;  // dK [N/m]
  Eigen::Matrix2cd slope;  // d dK/dw [N s/m]
};
SpuriousStiffness spurious_stiffness(std::span<const SpuriousResonance> modes,
                                     double omega);

}  // namespace beamgyro::internal
