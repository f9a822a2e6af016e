// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

/// Makes SIGINT, SIGTERM and SIGHUP remove the unfinished files of this
/// process, print what is kept, and end it by the same signal; a shell sees
/// status 130, 143 or 129. One that was ignored stays so.
void handle_interrupts();

}  // namespace beamgyro::internal
