// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

// The pictures are drawn by python/beamgyro/plots, which needs Python 3 with
// matplotlib and h5py. Each function below runs it and throws
// std::invalid_argument with its words when it refuses a file, and
// std::runtime_error when it fails or is not there.

/// Returns a file that is shipped with this program, in its source tree or
/// where it was installed, or an empty path when it is not there. `name` is its
/// path within the project.
std::filesystem::path shipped_file(const std::filesystem::path& name);

/// Writes `result`, the text of `--json` of validate or sensitivity, to
/// DIRECTORY/result.json, and a PNG of each of its figures beside it.
void draw_figures(const std::string& result,
                  const std::filesystem::path& directory);

/// Throws std::invalid_argument unless `path`, the argument of `option`, ends
/// in .png or .svg.
void require_picture_name(std::string_view option,
                          const std::filesystem::path& path);

/// Draws `result`, the text of `plan --json`, into the picture `path`.
void draw_plan(const std::string& result, const std::filesystem::path& path);

/// Draws a file, or several of one kind over each other, into `picture`.
/// `curves` has a line for each file: Compensator::curve(), or "null".
void draw_files(const std::vector<std::string>& files,
                const std::string& curves, bool compare,
                const std::filesystem::path& picture);

/// Shows the files in windows, one each or all in one, until they are closed.
void show_files(const std::vector<std::string>& files,
                const std::string& curves, bool compare);

}  // namespace beamgyro::internal
