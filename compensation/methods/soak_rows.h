// SPDX-License-Identifier: MIT
#pragma once

#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Returns the rows of soaks among rows of temperatures that change by
/// `steady_K_per_min` or less: those whose temperature changes by less than
/// half of the slowest ramp.
///
/// Rows that follow each other so slowly over more than kPointWidth hold a
/// ramp. Of such a stretch the rows slower than
/// half of its fastest tenth stay, until none is left that long. A ramp that
/// shows the same lag all along would otherwise count as dozens of soaks. Of a
/// stretch that becomes slower without such rows, within twice kPointWidth, the
/// slower half stays: it is a soak that settles.
TrainingRows rows_of_soaks(const TrainingRows& rows, double steady_K_per_min);

}  // namespace beamgyro::internal
