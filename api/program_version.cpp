// SPDX-License-Identifier: MIT
#include "api/program_version.h"

#include <fmt/format.h>

#include "include/beamgyro/version.h"

namespace beamgyro {
namespace internal {

const char* const kProgramVersion = BEAMGYRO_VERSION;

std::string history_line(const std::string& command) {
  return fmt::format("beamgyro {} ({}): {}", kProgramVersion, kGitRevision,
                     command);
}

}  // namespace internal

const char* version() noexcept { return internal::kProgramVersion; }
const char* git_revision() noexcept { return internal::kGitRevision; }

}  // namespace beamgyro
