// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro::internal {

// Of beamgyro/version.h, as files and reports name them.
extern const char* const kGitRevision;  // "unknown" outside a git checkout
extern const char* const kProgramVersion;

/// Returns the line of a file's history that says what this program did.
std::string history_line(const std::string& command);

}  // namespace beamgyro::internal
