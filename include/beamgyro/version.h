// SPDX-License-Identifier: MIT
/// \file
/// The version of the library: of the headers, and of what is linked.
#pragma once

#include "beamgyro/visibility.h"

#define BEAMGYRO_VERSION_MAJOR 0
#define BEAMGYRO_VERSION_MINOR 1
#define BEAMGYRO_VERSION_PATCH 0

namespace BEAMGYRO_PUBLIC beamgyro {

/// Returns the version of the linked library, "MAJOR.MINOR.PATCH". It is what
/// files contain as program_version.
const char* version() noexcept;

/// Returns the git revision that it was built from, or "unknown".
const char* git_revision() noexcept;

}  // namespace beamgyro
