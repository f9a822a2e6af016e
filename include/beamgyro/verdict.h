// SPDX-License-Identifier: MIT
/// \file
/// What is decided about a limit, and about a compensator.
#pragma once

#include <string_view>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// What a measured value says about a limit, after ASME B89.7.3.1: stringent
/// acceptance and stringent rejection, with a guard band on both sides of the
/// limit.
enum class Verdict {
  kPass,       ///< within the limits by the guard band or more
  kFail,       ///< beyond a limit by the guard band or more
  kUndecided,  ///< within the guard band, or never evaluated
};

/// Returns "pass", "fail", "undecided".
std::string_view verdict_name(Verdict verdict);

}  // namespace beamgyro
