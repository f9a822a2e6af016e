// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "compensation/methods/bias_model.h"
#include "compensation/models/parameter_json.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Adds the keys of a model, `input_scales`, `bias_scale` and `parameters`
/// (docs/reference/compensator_file.md), to `json`. Throws as finite_json().
void put_bias_model(const BiasModel& model, nlohmann::ordered_json& json);

/// Reads the name of a kind of model. Throws as JsonNode when there is no such
/// kind.
std::string read_bias_kind(const JsonNode& node);

/// Reads what put_bias_model() wrote for a model of that kind and so many
/// inputs. Throws as JsonNode.
BiasModel read_bias_model(const JsonNode& node, const std::string& kind,
                          std::size_t inputs);

}  // namespace beamgyro::internal
