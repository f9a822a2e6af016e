// SPDX-License-Identifier: MIT
#include "dataset/recording/attributes.h"

#include <fmt/format.h>

namespace beamgyro::internal {

VariableAbout status_about() {
  return {"status", "1", "state of the gyro", Role::kMeasured};
}

std::string source_text(std::string_view fidelity,
                        std::string_view program_version,
                        std::string_view git_revision) {
  const std::string what =
      fidelity == "imported" ? "log of a gyro, imported"
      : fidelity == "csv"
          ? "signals of a gyro, read from CSV"
          : fmt::format("{} simulation of a virtual gyro", fidelity);
  return program_version.empty() ? what
                                 : fmt::format("{} by beamgyro {} ({})", what,
                                               program_version, git_revision);
}

}  // namespace beamgyro::internal
