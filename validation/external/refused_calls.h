// SPDX-License-Identifier: MIT
#pragma once

namespace beamgyro::internal {

/// Refuses this process, for good, and all that it will start, the system calls
/// with which a process leaves a note for a later one or for a process outside,
/// where no rule on files sees it: on attributes of files, in memory and queues
/// of System V and POSIX, keys, sockets, and properties of other processes.
/// Nor can a process leave its process group. A refused call fails with EPERM.
/// Of the rights of root those over files stay. Call it with one thread. Throws
/// std::runtime_error with the reason when the kernel refuses it.
void refuse_calls();

}  // namespace beamgyro::internal
