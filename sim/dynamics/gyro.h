// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>

#include "sim/device/modal_model.h"
#include "sim/dynamics/lock_path.h"
#include "sim/dynamics/static_solution.h"

namespace beamgyro {

/// One unit after the factory: the device, its projected beam, and the trims
/// and references that are set once with board and beam at T_0 (2.4, 2.6).
struct Gyro {
  Device device;
  ProjectedBeam beam;
  double stiffness_trim = 0;  // k_trim [N/m]
  DriveLoop loop{};
  // d signal / dOmega at T_0: of the charge [C/(rad/s)], or, with force
  // rebalance, of the voltage on the damping patch [V/(rad/s)]; over
  // 1 + scale_factor_error, so that a rate shows with that error.
  std::complex<double> rate_axis{};
  double offset = 0;  // V_off/SF_0 at T_0 [rad/s]
};

/// Solves the beam and sets the trims: k_trim so that the input-referred
/// quadrature at T_0 is `quadrature_trim`, the demodulation reference
/// psi_d = arg dr/dOmega at T_0, and the output offset so that the zero-rate
/// output at T_0 is `offset_trim`. Throws SimulationFailure when the drive
/// loop cannot lock at T_0.
Gyro make_gyro(const Device& device);

/// Input-referred quadrature at T_0 [rad/s] with k_trim = `stiffness_trim`
/// [N/m] in place of one that was set for this unit. Throws SimulationFailure
/// when the drive loop cannot lock at T_0.
double built_quadrature(const Device& device, double stiffness_trim);

/// Demodulated, input-referred signal r/(dr/dOmega at T_0) [rad/s] with the
/// board at T_0: real part in phase with a rate, imaginary part minus the
/// quadrature. Its phase turns with phi_el of the board.
struct BeamSignal {
  std::complex<double> demodulated;  // [rad/s]
  double drive_frequency;            // w_d [rad/s]
  double drive_voltage;              // [V]
  bool amplitude_locked;
};

/// Exact static response at beam temperature T [K] (2.10), uncached; `path` of
/// this gyro and `guess` as in static_solution().
BeamSignal beam_signal(const Gyro& gyro, double T, const CaseMotion& motion);
BeamSignal beam_signal(const Gyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion);
BeamSignal beam_signal(const Gyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion, LockPath& path,
                       double guess = 0);

/// Input-referred output and quadrature channel before filter, saturation and
/// ADC [rad/s].
struct Output {
  double rate;
  double quadrature;
};

/// The board at one temperature (2.23): it turns the demodulated signal by
/// phi_el and adds V_off/SF_0.
struct Electronics {
  std::complex<double> turn;  // e^{i phi_el}
  double offset;              // [rad/s]

  Output output(std::complex<double> demodulated) const {
    const std::complex<double> turned = demodulated * turn;
    return {turned.real() + offset, -turned.imag()};
  }
};
Electronics electronics_at(const Gyro& gyro, double board_temperature);

/// Input-referred zero-rate terms B_0 - i Q_0 at one temperature, from the
/// exact solution: r/(dr/dOmega) at rate 0 [rad/s].
std::complex<double> zero_rate_terms(const Gyro& gyro,
                                     const ModalParameters& modal);

/// Slope of the output over rate at rate 0, board and beam at temperature T,
/// over that of T_0: 1 at T_0.
double rate_slope(const Gyro& gyro, const ModalParameters& modal, double T);

/// Heat the drive makes at T_0 [W]: 1/2 c w^2 A^2 in the beam and
/// 1/2 w C V^2 tan(delta) in the driven patch.
struct DriveHeating {
  double mechanical, dielectric;
};
DriveHeating drive_heating(const Gyro& gyro);

/// What an acceleration a [m/s2] of the case adds to the in-phase term,
/// b_g . a + r |a|^2 [rad/s] (2.1).
double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a);
/// The same with |a|^2 [m2/s4] given apart, for a vibration that a filter has
/// taken out of a.
double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a, double square);

/// d signal / dOmega at rate 0, in the unit of rate_axis, by a central
/// difference of the exact solution that is exact for its quadratic part.
std::complex<double> rate_response(const Gyro& gyro,
                                   const ModalParameters& modal);

}  // namespace beamgyro
