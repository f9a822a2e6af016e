// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

namespace beamgyro::internal {

/// The descriptor of a kept process at which it sees the end of the one that
/// started it: a pipe whose other end closes then.
constexpr int kLifeDescriptor = 3;

/// Forks. In the child, which is to run foreign code and is the leader of a
/// process group of its own, it returns nothing. This process stays as its
/// keeper: all that the child starts ends with it, whatever it does to get
/// away.
/// - It ends when the child ends, when the pipe at kLifeDescriptor closes, at
///   SIGTERM, and when all of them together use more than `memory` bytes (0: no
///   limit), which is said on standard error.
/// - `folder` is removed unless the child ended by itself.
/// - Then the keeper ends by the signal that ended the child, or it returns the
///   status to exit with: that of the child, or 1 after too much memory.
/// Throws std::system_error when the system refuses a process.
std::optional<int> keep_child(std::size_t memory,
                              const std::filesystem::path& folder);

}  // namespace beamgyro::internal
