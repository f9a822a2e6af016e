// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "cli/validate.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument when a file or directory that the arguments ask
/// for cannot be made, is one of the inputs, or is the same as another one or
/// inside it. Leaves none of them. The bundle has to be new besides
/// (require_new_bundle).
void require_outputs_of(const ValidateArguments& arguments,
                        const std::vector<std::filesystem::path>& inputs);

/// Prints a result, then writes files. What fails is printed, and the others
/// are written nevertheless. Returns `status`, or 1 when anything failed.
int deliver(std::string_view result,
            const std::vector<std::function<void()>>& files, int status);

}  // namespace beamgyro::internal
