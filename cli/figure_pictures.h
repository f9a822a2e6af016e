// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace beamgyro {

/// Returns a file that is shipped with this program, in its source tree or
/// where it was installed, or an empty path when it is not there. `name` is its
/// path within the project.
std::filesystem::path shipped_file(const std::filesystem::path& name);

/// Writes `result`, the text of `validate --json`, to DIRECTORY/result.json,
/// and a PNG of each of its figures beside it. scripts/validation_figures.py
/// draws them with Python and matplotlib. Throws std::runtime_error with what
/// the script said when it fails.
void draw_figures(const std::string& result,
                  const std::filesystem::path& directory);

}  // namespace beamgyro
