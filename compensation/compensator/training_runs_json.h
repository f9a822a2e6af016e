// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "compensation/compensator/compensator.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Adds which runs training fitted and held out: the keys `files`,
/// `held_out_files`, `set` and `held_out_set` of a compensator file.
void put_training_runs(const Provenance& provenance,
                       nlohmann::ordered_json& json);

/// Reads what put_training_runs() wrote. Throws std::invalid_argument with the
/// key, for a value that is missing, of the wrong type or out of range.
void read_training_runs(const JsonNode& node, Provenance& provenance);

}  // namespace beamgyro::internal
