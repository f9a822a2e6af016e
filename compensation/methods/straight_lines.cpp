// SPDX-License-Identifier: MIT
#include "compensation/methods/straight_lines.h"

#include <algorithm>
#include <cmath>

#include "compensation/methods/population.h"
#include "compensation/models/bias_function.h"
#include "compensation/uncertainty/sigma_calibration.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;

// Of each soak the rows, from the end of the settling on.
RowMask still_rows(const TrainingRows& rows) {
  RowMask still = RowMask::Constant(rows.size(), false);
  for (const RowStretch& cycle : stretches_of(rows.cycle)) {
    Index begin = cycle.begin;
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    const auto end_soak = [&](Index end) {
      if (end > begin && rows.time(end - 1) - rows.time(begin) >= kDwell)
        still.segment(begin, end - begin).setConstant(true);
      begin = end;
      lowest = HUGE_VAL;
      highest = -HUGE_VAL;
    };
    for (Index k = cycle.begin; k < cycle.end; ++k) {
      const double T = rows.temperature(k);
      if (std::max(highest, T) - std::min(lowest, T) > kStill) end_soak(k);
      lowest = std::min(lowest, T);
      highest = std::max(highest, T);
    }
    end_soak(cycle.end);
  }
  return still;
}

}  // namespace

std::optional<LookupTable> fit_straight_lines(const TrainingRows& rows) {
  const RowMask still = still_rows(rows);
  if (!still.any()) return {};
  const TrainingRows soaks = selected(rows, still);
  try {
    const LookupTable lines =
        fit_table_at_soaks(soaks.temperature, soaks.bias, kPointWidth);
    if (lines.temperatures.size() > 1) return lines;
  } catch (const UndeterminedFit&) {  // as slow as a ramp may be
  }
  return {};
}

}  // namespace beamgyro::internal
