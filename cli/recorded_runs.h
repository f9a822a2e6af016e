// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/rows/run_source.h"

namespace beamgyro {

/// Returns a source of recordings that reads each file when it is needed.
/// `paths` must outlive the source. A file that cannot be read throws as
/// read_recording().
RunSource runs_of_files(const std::vector<std::string>& paths);

/// Returns whether the paths are a single directory, that of a set. Throws
/// std::invalid_argument when one of several paths is a directory.
bool is_set(const std::vector<std::string>& paths);

}  // namespace beamgyro
