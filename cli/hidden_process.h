// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Where a library or a command cannot be isolated, closes the memory and the
/// open files of this process to other processes of the user, and empties its
/// command line, which they may read. Root reads the memory all the same. Does
/// nothing for other compensators.
void hide_from_code(const std::string& compensator,
                    const ProcessLimits& limits);

}  // namespace beamgyro::internal
