// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "validation/external/child_process.h"
#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Ends what a host tells of a library: without it the library has ended the
/// process before.
inline constexpr char kEndOfDescription = '\0';

/// First word of the command line of a program that is to call host_plugin()
/// with the rest.
constexpr std::string_view kPluginHostWord = "plugin-host";

/// What is asked of a process that hosts foreign code.
enum class HostTask {
  kTry,       // isolates itself and runs nothing of a command
  kDescribe,  // a library
  kAnswer,    // a library
  kCommand
};

/// Returns how a process of limits.program is started for a library, or for the
/// text of a command. It isolates itself first, unless isolation.landlock is 0.
ProcessStart host_start(const ProcessLimits& limits, const Isolation& isolation,
                        HostTask task, const std::string& target);

/// One record that the process reads: an operation, a time or a period [s], and
/// one value for each signal, all doubles of this machine.
enum class HostRecord { kStep = 0, kReset = 1 };

/// Status of kTry when a program that the command names is out of reach. On
/// standard error stand its path, and in the next line what would have to be
/// one of the plugin files.
constexpr int kProgramOutOfReach = 4;

/// Hosts foreign code in a process of its own, which is isolated for good, as
/// restrict_files() and refuse_calls() say. Its folder becomes that of HOME and
/// TMPDIR. `words` are those after kPluginHostWord, `search_path` the PATH of
/// its environment.
/// - A command takes the place of the process.
/// - To describe a library of beamgyro/plugin.h, it writes the names of the
///   signals on standard output, and after a line feed the runs that it was
///   trained on, if it states them. To answer, it reads records on standard
///   input to its end, and writes one double for each kStep.
/// On standard error it writes why it failed. Returns the exit status: 0, 1
/// when the isolation or the library failed, 2 when it is no library of this
/// kind, or kProgramOutOfReach.
int host_plugin(const std::vector<std::string>& words,
                const std::string& search_path);

}  // namespace beamgyro::internal
