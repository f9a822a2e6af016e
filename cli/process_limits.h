// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cli/command_line.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro {

/// The options that limit a library or a command.
struct LimitArguments {
  std::optional<double> timeout;  // [s]
  std::optional<double> memory;   // [GiB]
};

/// Adds --timeout-s and --memory-GiB.
void add_process_limits(Command& command, LimitArguments& arguments);

/// Returns the limits for compensators of this program.
ProcessLimits process_limits(const LimitArguments& arguments = {});

}  // namespace beamgyro
