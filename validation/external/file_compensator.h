// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "compensation/compensator/compensator.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Returns a trained compensator as one to be validated. It is evaluated in
/// this process.
std::unique_ptr<TestedCompensator> tested(FittedCompensator compensator);

}  // namespace beamgyro::internal
