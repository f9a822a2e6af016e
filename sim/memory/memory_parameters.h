// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

namespace beamgyro::internal {

inline constexpr double kGasConstant = 8.314462618;  // [J/(mol K)]

/// Structural relaxation of the bond, equations (12.1) and (12.2).
struct RelaxationParameters {
  double activation;     // dh [J/mol]
  double nonlinearity;   // x
  double modulus_per_K;  // kappa_G [1/K]
  // T_f - T_g before a run without a stated history [K]; absent: the bond was
  // cooled through T_g.
  std::optional<double> initial_offset;
};

inline constexpr std::size_t kPlayOperators = 4;

/// Rate-independent hysteresis, equations (12.3) and (12.4).
struct HysteresisParameters {
  std::array<double, kPlayOperators> half_width;  // r_i [K]
  std::array<double, kPlayOperators> weight;      // w_i, their sum is 1
  double stiffness;                               // c_k, of K_0
  double loss;                                    // c_eta, of K_0
  double mount_axis;                              // c_theta [rad]
};

/// Ageing, equation (12.5). A property is multiplied by 1 + (change per
/// decade) times MemoryState::decades.
struct AgeingParameters {
  double activation;       // E_a [J/mol]
  double start;            // t_1 [s]
  double trim_age;         // t_trim, effective [s]
  double patch_modulus;    // of E_p, per decade
  double d31;              // per decade
  double permittivity;     // per decade
  double mechanical_loss;  // of eta_p, per decade
  double bond_modulus;     // of G_U, per decade
  double mount_share;      // of k_m, per decade
};

/// The memory effects of one unit; an absent one is off.
struct MemoryParameters {
  std::optional<RelaxationParameters> relaxation;
  std::optional<HysteresisParameters> hysteresis;
  std::optional<AgeingParameters> ageing;

  bool any() const { return relaxation || hysteresis || ageing; }
};

/// What a unit remembers at one moment, as far as its static response depends
/// on it. All zeros is the unit as the factory trimmed it, with the bond in the
/// reference glass T_f,ref = max(T, T_g).
struct MemoryState {
  double glass_offset = 0;  // T_f - T_f,ref at the patches [K] (12.2)
  double hysteresis = 0;    // h/h_max, -1 .. 1 (12.3)
  double decades = 0;  // log10((t_e + t_1)/(t_trim + t_1)) of the age (12.5)

  bool operator==(const MemoryState&) const = default;
};

}  // namespace beamgyro::internal
