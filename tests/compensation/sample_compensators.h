// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"

namespace beamgyro::internal {

/// A network with the initial weights of a training.
BpNetwork random_network(const std::vector<int>& layers, std::uint64_t seed = 5,
                         std::uint32_t run = 0);

/// Irregular numbers in [-1, 1], a row for each sample.
Eigen::ArrayXXd wavy_inputs(Eigen::Index rows, Eigen::Index inputs);

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
