// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/external/compensator_stream.h"

namespace beamgyro::internal {

/// Reads samples as CSV on standard input, a line of names first, and prints an
/// answer for each on standard output, as soon as it is there: nan for a line
/// that is no sample, with one warning of each kind. Where the compensator
/// states a sigma, a line of names comes first, and the sigma after each rate.
/// Returns whether the compensator answered to the end. Throws
/// std::invalid_argument "standard input:line:
/// ..." for a line of names that is none.
bool answer_stream(CompensatorStream& stream, const std::string& compensator);

}  // namespace beamgyro::internal
