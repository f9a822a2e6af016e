// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/envelope.h"
#include "sim/signal/linear_noise.h"

namespace beamgyro::internal {

/// What beam or board change by before loop_noise() is taken anew [K].
inline constexpr double kNoiseRefresh = 2.0;

/// Returns the steady state of amplitudes, loops and filters with the beam at
/// `T_beam` and the board at `T_board` [K]. Throws as static_solution().
Eigen::VectorXd settled_state(const TrimmedGyro& gyro, const EnvelopeOde& ode,
                              const CaseMotion& motion, double T_beam,
                              double T_board);

/// Returns the linear system that carries Brownian, dielectric and amplifier
/// noise through amplitudes, loops and filters: the envelope linearised about
/// its steady state at rest. States have the indices of EnvelopeState, without
/// kRebalance in open loop. State kOutput2 is the noise of the output [rad/s],
/// kOutput2 + 1 is minus that of the quadrature.
NoiseSystem loop_noise(const TrimmedGyro& gyro, EnvelopeOde& ode, double T_beam,
                       double T_board);

/// Returns what the drive loop shows of the state z of loop_noise(), the rows
/// of C in (frequency [Hz], voltage [V]) = C z while it is locked.
Eigen::Matrix2Xd drive_channels(const LoopElectronics& loops);

/// Returns the white noise of drive frequency [Hz/sqrt(Hz)] and voltage
/// [V/sqrt(Hz)] well below the bandwidth of the loops, two-sided, so that N^2
/// times the output rate is the variance of a sample.
Eigen::Vector2d drive_noise(const LoopElectronics& loops,
                            const NoiseSystem& system);

/// Returns the rms of drive frequency [Hz] and voltage [V] over the whole
/// bandwidth.
Eigen::Vector2d drive_noise_rms(const LoopElectronics& loops,
                                const NoiseSystem& system);

}  // namespace beamgyro::internal
