// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "config/config_node.h"
#include "config/table.h"
#include "sim/campaign/distribution.h"

namespace beamgyro::internal {

/// A distribution. A discrete one also has its choices as they stand in the
/// file.
struct FileDistribution {
  Distribution distribution;
  std::vector<ConfigNode> values;
};

/// Reads `key = { normal = { mean, sigma } }` and the other forms
/// (docs/reference/campaign_file.md). Throws std::invalid_argument naming file,
/// line, key and value.
FileDistribution read_distribution(const ConfigTable& table,
                                   std::string_view key);

}  // namespace beamgyro::internal
