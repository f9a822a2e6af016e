// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "config/config_node.h"
#include "sim/campaign/distribution.h"

namespace beamgyro::internal {

/// The numbers that are drawn for each spurious mode of a unit.
enum SpuriousNumber {
  kDetuning,       // d_s
  kDetuningTc,     // a_s [1/K]
  kLossFactor,     // eta_s
  kHeight,         // h of (13.4), signed [degree/s]
  kCouplingRatio,  // |e_x/e_y|
  kSpuriousNumbers
};
inline constexpr std::array<std::string_view, kSpuriousNumbers>
    kSpuriousNumberKeys = {"detuning", "detuning_tc_per_K", "loss_factor",
                           "height_deg_per_s", "coupling_ratio"};

/// A population of spurious modes, `[spurious_modes]` of a campaign file. Units
/// have a random number of modes, and the couplings of a mode follow from the
/// height of its bump:
///
///   e_x e_y = 2 eta_s gamma h/w_0,   |e_x| = sqrt(|e_x e_y| r),
///   |e_y| = sqrt(|e_x e_y|/r),   e_y has the sign of h               (13.4)
struct SpuriousPopulation {
  std::vector<int> counts;  // choices of the number of modes
  Distribution count;       // kDiscrete, index of the choice
  std::array<Distribution, kSpuriousNumbers> of_mode;
  bool follow_housing = false;
  double product_per_height = 0;  // 2 gamma/w_0, of the base unit [s/degree]

  int most() const;  // modes of a unit
  std::size_t numbers() const;
};

/// Returns the table `spurious_mode` of a device file for independent uniform
/// numbers: that of the count, then those of each mode in the order of
/// SpuriousNumber. Numbers of modes beyond the count are not used. Appends the
/// parameters, one for each number: the count, then the values of every mode.
ConfigNode drawn_modes(const SpuriousPopulation& population,
                       const double* uniform, std::vector<double>& parameters);

}  // namespace beamgyro::internal
