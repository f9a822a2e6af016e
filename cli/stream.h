// SPDX-License-Identifier: MIT
#pragma once

#include "validation/external/compensator_stream.h"

namespace beamgyro::internal {

/// Reads samples as CSV on standard input, a line of names first, and prints an
/// answer for each on standard output, as soon as it is there. Where the
/// compensator states a sigma, a line of names comes first, and the sigma after
/// each rate. Returns the exit status. Throws std::invalid_argument "standard
/// input:line: ..." for what is no such CSV.
int answer_stream(CompensatorStream& stream, const std::string& compensator);

}  // namespace beamgyro::internal
