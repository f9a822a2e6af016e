// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "include/beamgyro/compensator.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument "name: ..." for a recording that could not be
/// written to a file, such as one whose times do not increase.
void require_sound(const Recording& recording, const std::string& name);

/// Throws std::invalid_argument for a recording, called `name`, that holds a
/// compensated rate already.
void require_uncompensated(const Recording& recording, const std::string& name);

/// Returns the answers of a compensator to a whole run, with its faults. Throws
/// std::invalid_argument "name: ..." as TestedCompensator::answers().
CompensatedRate checked_answer(const RateCompensator& compensator,
                               const Recording& recording,
                               const std::string& name);

/// Returns what to warn of, in a list of none or one.
std::vector<std::string> range_warnings(const RateCompensator& compensator,
                                        const CompensatedRate& answer,
                                        const std::string& name);

/// Adds the answers, where they come from and a line of history.
void add_answer(const RateCompensator& compensator, CompensatedRate answer,
                Recording& recording);

}  // namespace beamgyro::internal
