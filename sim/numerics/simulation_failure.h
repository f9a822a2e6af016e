// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace beamgyro {

/// One device cannot be simulated in one run: its equations have no solution,
/// its loops do not lock, or an integrator does not arrive. In a set this is
/// data; any other error is one of the program or of the machine.
class SimulationFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace beamgyro
