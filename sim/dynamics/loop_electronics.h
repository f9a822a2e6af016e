// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "sim/dynamics/gyro.h"

namespace beamgyro::internal {

/// The loops around the beam (2.1, 2.5), shared by envelope and carrier. (i, q)
/// are the (cos, sin) parts of the demodulated feedback s_F = -Theta_F^T q /
/// (|Theta_Fx(T_0)| A_ref) behind two poles w_f:
///
///   a = sqrt(i^2 + q^2),  delta = g(a) (atan2(i, q) - phi_pll)
///   theta' = w_nom + K_p delta + xi,         xi' = K_i delta
///   V = V_0 (K_pA e_A + eta),  e_A = 1 - a,  V_D = V within +-V_max
///   eta' = K_iA e_A + (V_D - V)/(V_0 T_w)
///
/// While the voltage stands at its limit the second term of eta' takes the
/// integral to where it would have to be (back-calculation), so that the loop
/// works again as soon as the limit allows. T_w = K_pA/K_iA.
///
/// g rises smoothly from 0 at kDetectionStart to 1 at kDetectionEnd, because a
/// phase detector needs a signal and a beam at rest has no phase.
///
/// The readout. phi_el of the board turns the reference of every demodulator
/// and modulator except that of the drive:
///
///   r = (Theta_R^T u + C_ft V_D) e^{i phi_el} / charge_axis -> two poles w_f
///   open loop:        z = r filtered
///   force rebalance:  z = -(k_I int r + k_P r), V_B = z voltage_axis
///                     e^{-i phi_el}, k_P = k_I / (1/tau_y - i Delta')
///   output = Re z -> two poles w_o, quadrature = -Im z -> two poles w_o
///
/// charge_axis is d(charge)/dOmega in open loop. With force rebalance it is H_0
/// voltage_axis, where H_0 is the response of the charge to V_B.
struct LoopElectronics {
  double nominal_frequency;   // w_nom, w_d at T_0 [rad/s]
  double nominal_voltage;     // V_0, V_D at T_0 [V]
  double voltage_limit;       // V_max [V]
  double feedback_scale;      // |Theta_Fx(T_0)| A_ref [C]
  double demodulator_corner;  // w_f [rad/s]
  double pll_phase;           // phi_pll [rad]
  double pll_proportional;    // K_p [1/s]
  double pll_integral;        // K_i [1/s2]
  double agc_proportional;    // K_pA
  double agc_integral;        // K_iA [1/s]
  double agc_tracking;        // 1/T_w [1/s]

  bool rebalance;
  double rebalance_integral;                        // k_I [1/s]
  std::complex<double> rebalance_proportional = 0;  // k_P

  std::complex<double> charge_axis;       // [C/(rad/s)]
  std::complex<double> voltage_axis = 0;  // force rebalance [V/(rad/s)]
  double feedthrough;                     // C_ft [F]
  double output_corner;                   // w_o [rad/s]
};

inline constexpr double kDetectionStart = 0.005;  // of the set amplitude
inline constexpr double kDetectionEnd = 0.02;

LoopElectronics loop_electronics(const TrimmedGyro& gyro);

/// g(a) and dg/da.
struct Detection {
  double gain, slope;
};
Detection phase_detection(double amplitude);

/// Quantities that the loops compute from their states at one moment.
struct DriveSignals {
  double amplitude;  // a
  double phase;      // atan2(i_2, q_2) - phi_pll [rad]
  Detection detection;
  double frequency;      // theta' [rad/s]
  double voltage;        // V_D [V]
  double integral_rate;  // eta' [1/s]
  bool limited;          // |V_D| stands at V_max

  double phase_error() const { return detection.gain * phase; }  // delta
  double amplitude_error() const { return 1 - amplitude; }       // e_A
};
DriveSignals drive_signals(const LoopElectronics& loops, double i2, double q2,
                           double xi, double eta);

inline constexpr double kAmplitudeErrorLocked = 0.01;  // of the set value
inline constexpr double kPhaseErrorLocked = 0.02;      // [rad]

/// Returns whether the loops hold amplitude and phase with the voltage below
/// its limit.
bool is_locked(const DriveSignals& drive);

}  // namespace beamgyro::internal
