// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

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
