// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/model_file.h"

namespace beamgyro {

/// What reports call it: "cubic", "BP network 2-8", ...
std::string method_name(const FitSpec& kind);

}  // namespace beamgyro
