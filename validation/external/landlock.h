// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

namespace beamgyro::internal {

/// Rights of the newest kernel that is known.
constexpr int kNewestLandlock = 7;

/// Takes from this process, for good, and from all that it will start, every
/// file but
/// - those of `readable`, to read and to execute, with all below a folder;
/// - `folder`, to read and to write;
/// - /dev/null, /dev/zero, /dev/urandom, and what /proc and /sys say of the
///   processors, the memory and this process itself.
/// Where Landlock has them (version 4, 6), TCP and the signals and abstract
/// sockets of other processes as well. Uses at most the rights of version
/// `highest` of Landlock. Names that are not there are passed over. Call it
/// with one thread. Throws std::runtime_error with the reason when the kernel
/// has no Landlock or refuses it.
void restrict_files(const std::vector<std::filesystem::path>& readable,
                    const std::filesystem::path& folder, int highest);

}  // namespace beamgyro::internal
