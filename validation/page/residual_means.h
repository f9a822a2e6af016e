// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validation/evidence/evidence.h"

namespace beamgyro {

/// Means over a block of samples of a run.
struct ResidualMean {
  double since_power_on;  // [s], middle of the block
  double temperature;     // [degC], measured
  double residual;        // [deg/s], rate - true_rate, of the finite samples
  std::size_t power_on;   // number of the power-on, from 0
};

/// Returns the means over blocks of `length` [s]. A block without a finite rate
/// is left out. Throws std::invalid_argument naming the run when it lacks a
/// column, or has not one rate per time.
std::vector<ResidualMean> residual_means(const EvidenceRun& run, double length);

/// Returns a length of blocks [s], `least` or longer, that divides the run into
/// about kFigurePoints at most.
double block_for_figure(const EvidenceRun& run, double least);

/// A soak, when its temperature has settled.
struct SettledSoak {
  double temperature;  // [degC], measured
  double residual;     // [deg/s]
  bool rising;         // from the soak before, or else to the next one
};

/// Returns the settled soaks of a run: the last ten minutes of every time
/// during which the measured temperature moves by less than 0.2 K in ten
/// minutes.
std::vector<SettledSoak> settled_soaks(const EvidenceRun& run);

/// Returns rate - true_rate [deg/s]; NaN where there is no rate. Throws as
/// residual_means().
std::vector<double> residuals(const EvidenceRun& run);

}  // namespace beamgyro
