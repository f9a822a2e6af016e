// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "sim/device/modal_model.h"
#include "sim/dynamics/static_solution.h"

namespace beamgyro::internal {

/// One unit after the factory: the device, its projected beam, and the trims
/// and references that are set once with board and beam at T_0 (2.4, 2.6).
struct TrimmedGyro {
  DeviceParameters device;
  ProjectedBeam beam;
  double stiffness_trim = 0;  // k_trim [N/m]
  DriveLoop loop{};
  // d signal / dOmega at T_0: of the charge [C/(rad/s)] or, with force
  // rebalance, of the voltage on the damping patch [V/(rad/s)]. It is divided
  // by 1 + scale_factor_error, so that a measured rate has that error.
  std::complex<double> rate_axis{};
  double offset = 0;  // V_off/SF_0 at T_0 [rad/s]
  // w_0 of (13.2), the drive frequency at T_0 without spurious modes [rad/s]; 0
  // for a unit that has none.
  double spurious_reference = 0;
};

/// Returns modal_parameters() of the trimmed unit, with its spurious modes and
/// the housing as warm as the beam.
ModalParameters modal_at(const TrimmedGyro& gyro, double T,
                         const MemoryState& memory = {});

/// The same with the housing at its own temperature [K], which matters to
/// spurious modes that follow it.
ModalParameters modal_at(const TrimmedGyro& gyro,
                         const SpuriousTemperatures& temperatures,
                         const MemoryState& memory = {});

/// Writes the spurious modes of a gyro at these temperatures to `modal`.
void add_spurious_modes(const TrimmedGyro& gyro,
                        const SpuriousTemperatures& temperatures,
                        const MemoryState& memory, ModalParameters& modal);

/// The frequency at which the drive loop of one gyro locks at rest, followed
/// from T_0 to other beam temperatures. Where there are several stable locks it
/// says which of them continues the lock at T_0. The path is computed on
/// demand. Use one object for one gyro only, and in one thread at a time.
class LockPath {
 public:
  /// Returns w_d [rad/s] at beam temperature `T` [K], or 0 when the lock of T_0
  /// ends before T.
  double at(const TrimmedGyro& gyro, double T);

 private:
  std::vector<double> colder_, warmer_;  // at T_0 -+ k steps; 0: ended
};

/// Returns static_solution() at `modal`. Of several stable locks it takes the
/// one nearest to `guess` [rad/s]. If `guess` is 0 it takes the one that
/// continues the lock at T_0 according to `path`, or where none does, the one
/// with the lowest voltage.
StaticSolution static_solution(const TrimmedGyro& gyro,
                               const ModalParameters& modal,
                               const CaseMotion& motion, LockPath& path,
                               double guess = 0);
StaticSolution static_solution(const TrimmedGyro& gyro,
                               const ModalParameters& modal,
                               const CaseMotion& motion, double guess = 0);

/// Solves the beam and sets the trims at T_0:
/// - k_trim, so that the input-referred quadrature is `quadrature_trim`;
/// - the demodulation reference psi_d = arg dr/dOmega;
/// - the output offset, so that the zero-rate output is `offset_trim`.
/// All of them are set with the spurious modes there. Throws SimulationFailure
/// when the drive loop cannot lock at T_0, and for a spurious mode that would
/// give it a second lock: e_x^2 Q_x/eta_s from 0.3, or |e_x| from eta_s (with
/// Q_x at T_0).
TrimmedGyro make_gyro(const DeviceParameters& device);

/// Returns the unit as the factory would have trimmed it without its spurious
/// modes.
TrimmedGyro without_spurious_modes(const TrimmedGyro& gyro);

/// Returns the input-referred quadrature at T_0 [rad/s] when k_trim is
/// `stiffness_trim` [N/m] in place of the value trimmed for this unit. Throws
/// SimulationFailure when the drive loop cannot lock at T_0.
double built_quadrature(const DeviceParameters& device, double stiffness_trim);

/// Demodulated, input-referred signal r/(dr/dOmega at T_0) [rad/s] with the
/// board at T_0. The real part is in phase with a rate, the imaginary part is
/// minus the quadrature. At another board temperature its phase is turned by
/// phi_el.
struct BeamSignal {
  std::complex<double> demodulated;  // [rad/s]
  double drive_frequency;            // w_d [rad/s]
  double drive_voltage;              // [V]
  bool amplitude_locked;
};

/// Solves the static response (2.10) at beam temperature T [K] exactly. `path`
/// is the LockPath of this gyro; `path` and `guess` are as in
/// static_solution().
BeamSignal beam_signal(const TrimmedGyro& gyro, double T,
                       const CaseMotion& motion);
BeamSignal beam_signal(const TrimmedGyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion);
BeamSignal beam_signal(const TrimmedGyro& gyro, const ModalParameters& modal,
                       const CaseMotion& motion, LockPath& path,
                       double guess = 0);

/// Input-referred output and quadrature channel [rad/s] before filter,
/// saturation and ADC.
struct Output {
  double rate;
  double quadrature;
};

/// The board at one temperature (2.23). It turns the demodulated signal by
/// phi_el and adds V_off/SF_0.
struct Electronics {
  std::complex<double> turn;  // e^{i phi_el}
  double offset;              // [rad/s]

  Output output(std::complex<double> demodulated) const {
    const std::complex<double> turned = demodulated * turn;
    return {turned.real() + offset, -turned.imag()};
  }
};
Electronics electronics_at(const TrimmedGyro& gyro, double board_temperature);

/// Returns the input-referred zero-rate terms B_0 - i Q_0 = r/(dr/dOmega) at
/// rate 0 [rad/s], from the exact solution at one temperature.
std::complex<double> zero_rate_terms(const TrimmedGyro& gyro,
                                     const ModalParameters& modal);

/// Returns the scale factor relative to that at T_0: the slope of the output
/// over rate at rate 0, with board and beam at T [K], divided by the slope at
/// T_0.
double rate_slope(const TrimmedGyro& gyro, const ModalParameters& modal,
                  double T);

/// Heat that the drive dissipates at T_0 [W]: 1/2 c w^2 A^2 in the beam and 1/2
/// w C V^2 tan(delta) in the driven patch.
struct DriveHeating {
  double mechanical, dielectric;
};
DriveHeating drive_heating(const TrimmedGyro& gyro);

/// Returns what an acceleration a [m/s2] of the case adds to the in-phase term,
/// b_g . a + r |a|^2 [rad/s] (2.1).
double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a);
/// The same with |a|^2 [m2/s4] given separately, for a vibration that a filter
/// has removed from a.
double in_phase_rate(const MountParameters& mount,
                     const std::array<double, 3>& a, double square);

/// Returns d signal / dOmega at rate 0, in the unit of rate_axis: a central
/// difference of the exact solution, which is exact for its quadratic part.
std::complex<double> rate_response(const TrimmedGyro& gyro,
                                   const ModalParameters& modal);

}  // namespace beamgyro::internal
