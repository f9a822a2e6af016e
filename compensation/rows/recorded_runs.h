// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "compensation/rows/run_source.h"

namespace beamgyro::internal {

/// Returns a source of recordings that calls `read`, read_recording() for one,
/// for each file when it is needed. `paths` must outlive the source.
RunSource runs_of_files(
    const std::vector<std::string>& paths,
    const std::function<Recording(const std::filesystem::path&)>& read);

/// Throws std::invalid_argument when a recording is there twice, under whatever
/// name: it would count twice.
void require_different_runs(const std::vector<std::string>& paths);

}  // namespace beamgyro::internal
