// SPDX-License-Identifier: MIT
#include "validation/external/tested_compensator.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "validation/external/file_compensator.h"

namespace beamgyro {

Answer TestedCompensator::answer(const Recording& run) const {
  return std::move(answers({&run}).front());
}

std::unique_ptr<TestedCompensator> open_tested_compensator(
    const std::string& argument, const ProcessLimits& limits) {
  static_cast<void>(limits);
  return tested(read_compensator(argument));
}

std::string tested_name(const std::string& argument) {
  if (argument.starts_with("cmd:")) return argument;
  return std::filesystem::path(argument).filename().string();
}

}  // namespace beamgyro
