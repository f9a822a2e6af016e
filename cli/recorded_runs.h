// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/run_source.h"

namespace beamgyro {

/// The runs of recordings, each read when its turn comes; `paths` must outlive
/// the source. A file that cannot be read throws as read_recording().
RunSource runs_of_files(const std::vector<std::string>& paths);

/// Whether the paths are one directory, a set. Throws std::invalid_argument
/// when there is a directory among several.
bool is_set(const std::vector<std::string>& paths);

}  // namespace beamgyro
