// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/methods/fit_spec.h"

namespace beamgyro {

/// Returns the name of a method in reports: "cubic", "BP network 2-8", ...
std::string method_name(const FitSpec& kind);

}  // namespace beamgyro
