// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// Network 3-6-4-1 on temperature, a low-pass and the time since power-on.
FittedCompensator network_compensator();

/// Inputs "temperature" and a spline with knots every 90/13 K over -40..50.
FittedCompensator spline_compensator();

/// The same with a sigma that has every term, in the range of the compensator.
FittedCompensator with_sigma(FittedCompensator c);

struct NamedCompensator {
  std::string name;
  FittedCompensator compensator;
};

/// One of every kind, some with a sigma, and a network with a scale-factor
/// table and every input.
std::vector<NamedCompensator> one_of_each_kind();

}  // namespace beamgyro::internal
