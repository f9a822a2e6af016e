// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace beamgyro::internal {

/// Returns a file that is shipped with this program, in its source tree or
/// where it was installed, or an empty path when it is not there. `name` is its
/// path within the project.
std::filesystem::path shipped_file(const std::filesystem::path& name);

/// A script that draws what a command found, and the option that asks for it.
struct FigureScript {
  const char* option;  // "--figures"
  const char* script;  // "scripts/validation_figures.py"
};

/// Writes `result`, the text of `--json`, to DIRECTORY/result.json, and a PNG
/// of each of its figures beside it. The script draws them with Python and
/// matplotlib. Throws std::runtime_error with what the script said when it
/// fails.
void draw_figures(const FigureScript& drawn_by, const std::string& result,
                  const std::filesystem::path& directory);

/// Throws std::invalid_argument unless `path` ends in .png or .svg.
void require_picture_name(const std::filesystem::path& path);

/// Draws `result`, the text of `plan --json`, into the picture `path`.
/// scripts/plan_figure.py does it. Throws as draw_figures().
void draw_plan(const std::string& result, const std::filesystem::path& path);

}  // namespace beamgyro::internal
