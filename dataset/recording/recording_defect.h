// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

// Beyond it sums of squares overflow, and no signal of a gyro comes near.
inline constexpr double kLargestValue = 1e12;

/// Returns the first defect of a recording as one line that names the variable
/// and the sample, or an empty text. A recording without a defect has
/// - at least one sample, with finite, strictly increasing times;
/// - one status and one value of every column for each time;
/// - column names that are unique identifiers;
/// - the unit of the table of signals in each column that is named there, or
///   none;
/// - finite values, except NaN in measured and compensated columns where the
///   status says unpowered; none beyond +-1e12;
/// - no NUL in any text.
std::string recording_defect(const Recording& recording);

/// The same for names and texts alone, and for samples alone, which are
/// numbered from `first`.
std::string head_defect(const Recording& recording);
std::string samples_defect(const Recording& recording, std::size_t first);

}  // namespace beamgyro::internal
