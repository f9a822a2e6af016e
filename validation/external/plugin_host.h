// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// First word of the command line of a program that is to call host_plugin()
/// with the rest.
constexpr std::string_view kPluginHostWord = "plugin-host";

/// What is asked of a process that loads a library.
enum class HostTask { kDescribe, kAnswer };

/// Returns the words of a process of `program` for a library. `memory`: as in
/// ProcessLimits.
std::vector<std::string> plugin_host_words(const std::filesystem::path& program,
                                           const std::filesystem::path& library,
                                           HostTask task, std::size_t memory);

/// One record that the process reads: an operation, a time or a period [s], and
/// one value for each signal, all doubles of this machine.
enum class HostRecord { kStep = 0, kReset = 1 };

/// Serves a library of beamgyro/plugin.h in a process of its own. To describe,
/// it writes the names of the signals on standard output, and after a line feed
/// the runs that it was trained on, if it states them. To answer, it reads
/// records on standard input to its end, and writes one double for each kStep.
/// On standard error it writes why it failed. `words` are those after
/// kPluginHostWord. Returns the exit status: 0, 1 when the library failed, or
/// 2 when it is no library of this kind.
int host_plugin(const std::vector<std::string>& words);

}  // namespace beamgyro::internal
