// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "sim/memory/memory_parameters.h"
#include "sim/signal/loop_channels.h"
#include "sim/signal/noise.h"
#include "sim/signal/temperature_sensor.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {

/// Patches in the order of every per-patch array: drive on +x, feedback on -x,
/// readout on +y, damping or rebalance on -y.
enum Patch { kDrive, kFeedback, kReadout, kDamping, kPatchCount };

template <class T>
using PerPatch = std::array<T, kPatchCount>;

struct BeamParameters {
  double length;             // L [m]
  double side;               // a [m]
  double side_difference;    // eps_s: a_x = a (1 + eps_s/2), a_y = a (1 - ..)
  double youngs_modulus;     // E_0 [Pa]
  double density;            // rho [kg/m3]
  double poisson_ratio;      // nu
  double modulus_tc1;        // tec1 [1/K]
  double modulus_tc2;        // tec2 [1/K2]
  double thermal_expansion;  // cte [1/K]
  double loss_factor;        // eta_m
  double thermal_conductivity;         // k [W/(m K)]
  double specific_heat;                // c [J/(kg K)]
  std::optional<double> angular_gain;  // gamma; computed when absent
};

struct PatchParameters {
  double length, width, thickness;  // l_p, w_p, t_p [m]
  double youngs_modulus;            // 1/s11E [Pa]
  double density;                   // [kg/m3]
  double d31;                       // [C/N]
  double relative_permittivity;     // eps33T / eps0
  double loss_tangent;              // tan delta
  double mechanical_loss_factor;    // eta_p
  double modulus_tc;                // [1/K]
  double d31_tc;                    // [1/K]
  double permittivity_tc;           // [1/K]
  double mechanical_loss_tc;        // [1/K]
  PerPatch<double> offset;          // delta_p, lateral [m]
};

struct BondParameters {
  PerPatch<double> thickness;   // t_b [m]
  double shear_modulus;         // G_U, unrelaxed [Pa]
  double beta_step;             // dG_b [Pa]
  double beta_exponent;         // a_b
  double beta_activation;       // E_b [J/mol]
  double beta_temperature;      // T_1, peak at 1 Hz [K]
  double alpha_step;            // dG_a [Pa]
  double alpha_exponent;        // a_a
  double glass_transition;      // T_g [K]
  double alpha_low_activation;  // below T_g [J/mol]
};

struct MountParameters {
  double glassy_stiffness_share;  // k_m, of the modal stiffness
  double rubber_glass_ratio;
  double exponent;          // a_m
  double glass_transition;  // T_g [K]
  double anisotropy;        // r_m
  double axis_angle;        // th_m [rad]
  double low_activation;    // below T_g [J/mol]
  double pin_stiffness;     // k_pin, axial [N/m]
  // Rate-equivalent in-phase term of an acceleration a, b_g . a + r |a|^2.
  std::array<double, 3> g_sensitivity;  // b_g along x, y, z [(rad/s)/(m/s2)]
  double rectification;                 // r [(rad/s)/(m/s2)^2]
};

struct DriveParameters {
  double amplitude;            // A_ref, tip [m]
  double pll_phase;            // phi_pll [rad]
  double voltage_limit;        // V_max [V]
  double demodulator_corner;   // w_f, of each of two poles [rad/s]
  double pll_bandwidth;        // K_p [rad/s]
  double pll_integral_corner;  // sqrt(K_i) [rad/s]
  double agc_bandwidth;        // K_pA / tau_x [rad/s]
  double agc_integral_corner;  // K_iA / K_pA [rad/s]
};

enum class ReadoutMode { kOpenLoop, kForceRebalance };

struct ReadoutParameters {
  ReadoutMode mode;
  double feedback_capacitance;   // C_f [F]
  double feedthrough;            // C_ft [F]
  double rebalance_bandwidth;    // k_I, force rebalance only [rad/s]
  double amplifier_noise;        // e_n, one-sided [V/sqrt(Hz)]
  double input_capacitance;      // C_in of the amplifier [F]
  double quadrature_trim;        // Q_0 at T_0 [rad/s]
  double offset_trim;            // output at T_0 and rate 0 [rad/s]
  double scale_factor;           // nominal [V/(rad/s)]
  double scale_factor_error;     // true one at T_0 over the nominal, less 1
  double offset;                 // [V]
  double full_scale;             // [rad/s]
  double phase_tc, phase_tc2;    // [rad/K rad/K2]
  double offset_tc, offset_tc2;  // [rad/s/K rad/s/K2]
  double corner_frequency;       // of each of two real poles [rad/s]
  int adc_bits;
  double drive_frequency_resolution;  // [Hz]
  double drive_voltage_resolution;    // [V]
  double quadrature_resolution;       // [rad/s]
};

inline constexpr std::size_t kMostSpuriousModes = 16;

/// A resonance of another part, such as a lead wire, that is weakly coupled to
/// both modes of the beam (13.1). Its frequency is
///
///   w_s = w_0 [1 + d_s + a_s (T_s - T_0)]                            (13.2)
///
/// with w_0 the drive frequency that the unit has at T_0 without such modes.
struct SpuriousModeParameters {
  std::string name;
  double detuning;        // d_s at T_0
  double detuning_tc;     // a_s [1/K]
  double loss_factor;     // eta_s
  double coupling_drive;  // e_x
  double coupling_sense;  // e_y, signed
  bool follows_housing;   // T_s is that of the housing, else of the beam
  double drift = 0;       // of d_s per decade of age (12.5)
  double slip = 0;        // of d_s where h = h_max (12.3)
};

/// One unit, complete: what a device file holds, in SI units.
struct DeviceParameters {
  BeamParameters beam;
  PatchParameters patches;
  BondParameters bond;
  MountParameters mount;
  double air_inverse_Q;
  DriveParameters drive;
  ReadoutParameters readout;
  ThermalParameters thermal;
  NoiseParameters noise;
  TemperatureSensorParameters temperature_sensor;
  std::optional<LoopChannelParameters> loop_channels;  // none: without errors
  MemoryParameters memory = {};
  std::vector<SpuriousModeParameters> spurious_modes = {};
};

/// Calibration temperature T_0 of every expansion and trim [K].
inline constexpr double kCalibrationTemperature = 298.15;

}  // namespace beamgyro::internal
