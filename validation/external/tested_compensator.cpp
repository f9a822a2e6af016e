// SPDX-License-Identifier: MIT
#include "validation/external/tested_compensator.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "validation/external/command_compensator.h"
#include "validation/external/file_compensator.h"
#include "validation/external/library_compensator.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kCommandPrefix = "cmd:";

}  // namespace

bool is_command(std::string_view argument) {
  return argument.starts_with(kCommandPrefix);
}

bool is_library(std::string_view argument) {
  return !is_command(argument) && argument.ends_with(".so");
}

Answer TestedCompensator::answer(const Recording& run) const {
  return std::move(answers({&run}).front());
}

std::unique_ptr<TestedCompensator> open_tested_compensator(
    const std::string& argument, const ProcessLimits& limits) {
  if (is_command(argument)) return open_command(argument, limits);
  if (is_library(argument)) return open_library(argument, limits);
  return tested(read_compensator(argument));
}

std::string tested_name(const std::string& argument) {
  if (is_command(argument)) return argument;
  return std::filesystem::path(argument).filename().string();
}

}  // namespace beamgyro::internal
