// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Names of what a command tries that wants to see what it is judged by, or to
/// leave a note for a later start of it.
std::vector<std::string> attack_names();

/// Lets a command try all of it in a new folder below `directory`, and returns
/// the names of what works. `memory` is a text of this process that it wants to
/// read.
std::vector<std::string> working_attacks(const std::filesystem::path& directory,
                                         const ProcessLimits& limits,
                                         const std::string& memory);

/// Calls `work` in a process of its own, as a user without rights if `is_user`
/// and this process is root's, and returns what it returns, or the words of
/// what it throws.
std::string in_process(bool is_user, const std::function<std::string()>& work);

/// Lets this process meet a kernel that answers `error` to each call of
/// Landlock.
void lose_landlock(int error);

}  // namespace beamgyro::internal
