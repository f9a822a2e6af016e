// SPDX-License-Identifier: MIT
/// \file
/// Which tolerance of a population causes the spread of its drift.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "beamgyro/campaign.h"
#include "beamgyro/compensator.h"
#include "beamgyro/progress.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

struct SensitivityOptions {
  /// Figures of merit: bias_pp_deg_per_s, cubic_rms_deg_per_s,
  /// scale_factor_drift_rel, warm_up_change_deg_per_s, quadrature_deg_per_s,
  /// compensator_rms_deg_per_s; none: the first four.
  std::vector<std::string> figures = {};
  /// Adds compensator_rms_deg_per_s: what it leaves.
  std::optional<Compensator> compensator = {};
  double lowest_degC = -40, highest_degC = 50;
  /// Studies every figure as it is, not the logarithm of positive ones.
  bool linear = false;
  /// Largest magnitudes that are good, by figure; they add yields.
  std::map<std::string, double> limits = {};
  /// Share of good devices that is wanted of each limit, in (0, 1): adds how
  /// narrow single tolerances have to be for it.
  std::optional<double> yield = {};
  /// Each takes a device for every tolerance and three more; 32 to 1,000,000.
  std::size_t samples = 2048;
  std::optional<std::uint64_t> seed = {};  ///< that of the campaign without
  unsigned jobs = 0;                       ///< threads; 0: one per core
  Progress progress = {};
};

/// Sobol' indices of one tolerance, with their intervals of 95 %.
struct SensitivityIndex {
  std::string key;  ///< of the device file
  double first, first_low, first_high;
  double total, total_low, total_high;
};

/// What was found for a figure of merit.
struct SensitivityFigure {
  std::string name;
  std::vector<SensitivityIndex> indices;
};

struct SensitivityResult {
  std::vector<SensitivityFigure> figures;
  std::string text;  ///< what `beamgyro sensitivity` prints
  std::string json;  ///< what `--json` writes
  /// Devices whose curve their user would not see: at the voltage limit, beyond
  /// the full scale.
  std::vector<std::string> warnings = {};
};

/// Samples devices of a campaign and computes the indices. The result does not
/// depend on the number of threads. Throws std::invalid_argument for an unknown
/// figure, a limit of a figure that is not studied, a range that is empty or
/// beyond the materials, and a campaign whose tolerances cannot be compared;
/// and Cancelled.
SensitivityResult sensitivity(const Campaign& campaign,
                              const SensitivityOptions& options = {});

}  // namespace beamgyro
