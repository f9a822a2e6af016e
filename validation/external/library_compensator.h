// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>

#include "validation/external/conversation.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Opens a shared library with the interface of beamgyro/plugin.h. It is loaded
/// by processes of limits.program only. Throws std::invalid_argument with its
/// name when it is no such library or asks for what is not measured.
std::unique_ptr<TestedCompensator> open_library(
    const std::filesystem::path& library, const ProcessLimits& limits,
    const Isolation& isolation);

/// Returns how a library is run in a process. Throws as open_library().
AnsweringProcess library_process(const std::filesystem::path& library,
                                 const ProcessLimits& limits,
                                 const Isolation& isolation);

}  // namespace beamgyro::internal
