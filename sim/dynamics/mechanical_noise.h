// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

inline constexpr double kBoltzmann = 1.380649e-23;  // k_B, exact [J/K]

/// One-sided noise densities around the drive frequency at one temperature: of
/// the force on the modes, and of the charges in front of the demodulators.
/// Charges are those of one patch with its charge amplifier; the readout patch
/// and the feedback patch each have their own.
struct NoiseDensities {
  Eigen::Matrix2d force;  // 4 k_B T C on both modes [N2/Hz]
  double dielectric;      // 4 k_B T tan(delta) C_p / w_d [C2/Hz]
  double amplifier;       // (e_n (C_p + C_f + C_in))^2 [C2/Hz]
};

/// Returns all densities at beam temperature T [K]. `modal` belongs to that
/// temperature, w_d [rad/s] is the drive frequency. Throws
/// std::invalid_argument for a temperature or a frequency not above 0.
NoiseDensities noise_densities(const DeviceParameters& device,
                               const ModalParameters& modal, double T,
                               double drive_frequency);

/// A real noise of one-sided density S_1 around w_d is Re[n e^{i theta}] with
/// complex white n, real and imaginary part independent and each of intensity
///   E[n_r(t) n_r(t')] = S_1 delta(t - t'),
/// which is one-sided density 2 S_1. So a demodulator with pole w_f behind
/// charge noise has the input w_f sqrt(S_1) dW in each of its two channels.
///
/// The force noise drives the amplitudes, q = Re[u e^{i theta}]:
///   dz = A z dt + input dW,   u dt = z dt + direct dW,
/// with a complex dW for each mode, ordered Re X, Im X, Re Y, Im Y. With P per
/// mass, `input` is the residue of (2.10) at its slow root,
///   R = (P + 2 A)^-1 / m,    input = R sqrt(4 k_B T C),
/// which gives every mode <|Y|^2> = 2 k_B T / k; one mode alone has s^2 = 2 k_B
/// T / (k tau) in each channel. `direct` is what the fast root leaves at low
/// frequencies,
///   direct = -(P + A)^-1 input,
/// and makes u the static S^-1 f there; without it that limit is off by
/// Delta/w, 0.8 %. It belongs to the input of whatever filters u.
struct BrownianInput {
  Eigen::Matrix4d input;   // [m/sqrt(s)]
  Eigen::Matrix4d direct;  // [m sqrt(s)]
};

/// `A` [1/s] is that of u' = A u, a complex 2 x 2 matrix in its real form: a
/// block [[a, -b], [b, a]] for each element a + i b. `velocity` [1/s] is that
/// of ModeForces, so that P = 2 i w_d + velocity. Throws std::invalid_argument
/// when A is not of that form (to 1e-6 of its largest element), for a force
/// density [N2/Hz] that is not positive semidefinite, and for a mass [kg] or a
/// frequency [rad/s] not above 0.
BrownianInput brownian_input(const Eigen::Matrix2d& force_density, double mass,
                             const Eigen::Matrix2d& velocity,
                             const Eigen::Matrix4d& A, double drive_frequency);

/// Rate-equivalent white noise by source, at frequencies well below the
/// bandwidth of every loop and filter. Densities are one-sided at the output,
/// so their squares add to that of the white noise of the output stage:
///   N = total() / sqrt(2)  [rad/sqrt(s)].
struct RateNoiseDensity {
  double brownian, dielectric, amplifier;  // [rad/s/sqrt(Hz)]

  double total() const;
};

/// Linearised static response (2.10) to a force and to charges on the readout
/// and the feedback patch, the loops closed: the phase and, unless the voltage
/// stands at its limit, the amplitude of the feedback are held; with force
/// rebalance the readout's charge is. At rest, beam and board at temperatures
/// [K]. Throws as noise_densities() and static_solution().
RateNoiseDensity low_frequency_noise(const TrimmedGyro& gyro,
                                     double beam_temperature,
                                     double board_temperature);

/// Returns the white noise of the sensing in front of the output stage at T_0,
/// as an angle random walk N [rad/sqrt(s)].
double sensing_angle_random_walk(const TrimmedGyro& gyro);

/// Returns the noise that the output of a gyro shows: that of its output stage,
/// with that of the sensing in its white noise.
NoiseParameters output_noise(const TrimmedGyro& gyro);

}  // namespace beamgyro::internal
