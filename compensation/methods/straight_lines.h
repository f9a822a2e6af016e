// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "compensation/models/lookup_table.h"
#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Returns straight lines between the soaks of rows, with the mean of each, or
/// nothing where the rows hold no two soaks that can be told apart: of a ramp
/// there are none.
///
/// A soak is a stretch of rows of one cycle over which the temperature stays
/// within kStill for kDwell or longer. Soaks within kPointWidth of each other
/// count as one, as fit_table_at_soaks() joins them. Rows beside them, of ramps
/// and warm-ups, are left out: there sensor and beam differ.
std::optional<LookupTable> fit_straight_lines(const TrainingRows& rows);

constexpr double kStill = 0.25;  // [K]
constexpr double kDwell = 240;   // [s], from the first row to the last

}  // namespace beamgyro::internal
