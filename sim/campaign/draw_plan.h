// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/config_node.h"
#include "config/overrides.h"
#include "dataset/set/shard/shard.h"
#include "sim/campaign/copula.h"
#include "sim/campaign/distribution.h"
#include "sim/campaign/uniform_source.h"

namespace beamgyro::internal {

/// One key of a device or scenario file that differs between devices.
struct Draw {
  std::vector<std::string> path;  // the key, split at its dots
  std::string place;              // of its distribution, "file:line:column"
  Distribution distribution;
  std::vector<ConfigNode> values;  // choices of a discrete one
  bool numeric = true;             // the parameter is the value, else its index
  std::size_t elements = 0;  // of an array, each drawn by itself; 0: one value

  std::size_t numbers() const { return elements == 0 ? 1 : elements; }
};

/// The dotted key.
std::string key_of(const Draw& draw);

/// Everything that is drawn for a device, or for one run of it.
struct DrawPlan {
  std::vector<Draw> draws;
  // One entry of each for each number, in the order of the draws.
  std::vector<DeviceVariable> parameters;
  std::vector<std::uint32_t> streams;
  std::size_t first_dimension = 0;  // of the Sobol' points
  std::vector<CorrelatedGroup> groups;
};

/// The drawn values of one device, in the order of the draws.
struct DrawnValues {
  std::vector<double> parameters;  // one per DrawPlan::parameters
  std::vector<ConfigNode> values;  // one per DrawPlan::draws
};

/// Returns the value of one key for independent uniform numbers, one for each
/// element, and appends its parameters.
ConfigNode drawn_value(const Draw& draw, const double* uniform,
                       std::vector<double>& parameters);

DrawnValues drawn_values(const DrawPlan& plan, const UniformSource& source,
                         std::uint32_t device);

/// The same for given independent uniform numbers in (0, 1), one per
/// DrawPlan::parameters.
DrawnValues drawn_values(const DrawPlan& plan, std::vector<double> uniform);

/// Returns the values as overrides of the file that they belong to.
Overrides overrides_of(const DrawPlan& plan,
                       const std::vector<ConfigNode>& values);

}  // namespace beamgyro::internal
