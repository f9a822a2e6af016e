// SPDX-License-Identifier: MIT
#include "cli/process_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "api/validation_members.h"

namespace beamgyro::internal {
namespace {

constexpr double kGibibyte = 1073741824.0;  // bytes
constexpr double kMostMemory = 1048576.0;   // [GiB]
constexpr double kLongestTimeout = 1e6;     // [s]

}  // namespace

void add_process_limits(Command& command, LimitArguments& arguments) {
  command.group(std::string(kCodeHeading));
  command.number({"--timeout-s", "S",
                  "Time without a sample taken or an answer given after which "
                  "it hangs",
                  "10"},
                 arguments.timeout, {1e-3, kLongestTimeout});
  command.number({"--memory-GiB", "N", "Memory that it may use", "2"},
                 arguments.memory, {1e-3, kMostMemory});
}

void require_limits_for_code(const LimitArguments& arguments,
                             const std::string& compensator) {
  if (!arguments.timeout && !arguments.memory) return;
  if (is_program(source_kind(compensator))) return;
  throw std::invalid_argument(fmt::format(
      "{} is for a library or a command; {} is neither",
      arguments.timeout ? "--timeout-s" : "--memory-GiB", compensator));
}

ProcessLimits process_limits(const LimitArguments& arguments,
                             IsolationOptions isolation) {
  ProcessLimits limits;
  limits.isolation = std::move(isolation);
  limits.program = "/proc/self/exe";
  if (arguments.timeout) limits.stall = *arguments.timeout;
  if (arguments.memory)
    limits.memory =
        static_cast<std::size_t>(std::llround(*arguments.memory * kGibibyte));
  return limits;
}

}  // namespace beamgyro::internal
