// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro {

/// Makes SIGINT and SIGTERM remove the unfinished files of this process and end
/// it with status 130 or 143.
void handle_interrupts();

}  // namespace beamgyro
