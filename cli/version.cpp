// SPDX-License-Identifier: MIT
#include "cli/version.h"

#include <fmt/format.h>

#include <CLI/Version.hpp>

namespace beamgyro::internal {

std::string version_text() {
  return fmt::format(
      "beamgyro {} ({})\n"
      "Eigen {}, SUNDIALS {}, HDF5 {}, CLI11 {}, fmt {}, {}",
      kProgramVersion, kGitRevision, BEAMGYRO_EIGEN_VERSION,
      BEAMGYRO_SUNDIALS_VERSION, BEAMGYRO_HDF5_VERSION, CLI11_VERSION,
      FMT_VERSION,
#ifdef __clang__
      "clang " __clang_version__
#else
      "gcc " __VERSION__
#endif
  );
}

}  // namespace beamgyro::internal
