// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "api/program_version.h"  // IWYU pragma: export

namespace beamgyro::internal {

/// Returns program, revision and libraries for --version.
std::string version_text();

}  // namespace beamgyro::internal
