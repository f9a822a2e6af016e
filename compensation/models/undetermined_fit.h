// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace beamgyro::internal {

/// The rows do not determine the parameters of a fit. Fits to some of the rows
/// may end so though a fit to all of them does not.
class UndeterminedFit : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace beamgyro::internal
