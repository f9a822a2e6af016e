// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Returns what beamgyro::Compensator::curve() says.
std::string settled_curve(const FittedCompensator& compensator);

}  // namespace beamgyro::internal
