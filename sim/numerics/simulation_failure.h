// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace beamgyro::internal {

/// Thrown when one device cannot be simulated in one run: its equations have no
/// solution, its loops do not lock, or an integrator does not reach the end. In
/// a set such a device is recorded as failed. Any other exception is an error
/// of the program or of the machine.
class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace beamgyro::internal
