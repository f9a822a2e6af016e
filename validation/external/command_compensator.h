// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "validation/external/conversation.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Returns the command of an argument "cmd:PROGRAM ARGS". Throws
/// std::invalid_argument for an empty one.
std::string command_of(const std::string& argument);

/// Returns how such a command is run. Throws as command_of().
AnsweringProcess command_process(const std::string& argument,
                                 const ProcessLimits& limits,
                                 const Isolation& isolation);

/// Returns a command as a compensator. The shell runs it anew at each power-on.
/// It reads CSV: a line of names, `time` first, then a line for each powered
/// sample with every measured variable of the recording. It writes a line with
/// one rate for each sample, at once or later. Throws as command_of().
std::unique_ptr<TestedCompensator> open_command(const std::string& argument,
                                                const ProcessLimits& limits,
                                                const Isolation& isolation);

}  // namespace beamgyro::internal
