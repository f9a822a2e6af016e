// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace beamgyro::internal {

/// Returns the ending of a name in small letters, with its dot: that of RUN.H5
/// is ".h5". Empty without one.
std::string file_ending(const std::filesystem::path& path);

}  // namespace beamgyro::internal
