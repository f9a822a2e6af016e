// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "cli/command_line.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {

/// The options that limit a library or a command.
struct LimitArguments {
  std::optional<double> timeout;  // [s]
  std::optional<double> memory;   // [GiB]
};

/// Adds --timeout-s and --memory-GiB.
void add_process_limits(Command& command, LimitArguments& arguments);

/// Throws std::invalid_argument when one of them is given for a compensator
/// that is no library and no command.
void require_limits_for_code(const LimitArguments& arguments,
                             const std::string& compensator);

/// Returns the limits for compensators of this program.
ProcessLimits process_limits(const LimitArguments& arguments = {},
                             IsolationOptions isolation = {});

}  // namespace beamgyro::internal
