// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator/compensator.h"
#include "include/beamgyro/compensator.h"

namespace beamgyro {

struct Compensator::State {
  std::string text, name;
  std::string file;  // its path; empty when it is in memory only
  internal::FittedCompensator compensator;

  /// Returns its path, or the name that it was given in memory.
  const std::string& path() const { return file.empty() ? name : file; }
};

}  // namespace beamgyro
