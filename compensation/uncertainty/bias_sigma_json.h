// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "compensation/uncertainty/bias_sigma.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// Put the members `power_on` and `temperature_rate` that are there, and read
/// them. Throw as bias_sigma_json() and read_bias_sigma().
void put_sigma_terms(const std::optional<SigmaTerm>& power_on,
                     const std::optional<SigmaTerm>& temperature_rate,
                     nlohmann::ordered_json& json);
std::optional<SigmaTerm> read_power_on_sigma(const JsonNode& node);
std::optional<SigmaTerm> read_temperature_rate_sigma(const JsonNode& node);

/// Reads the member `half_width`; 0 where it is not there, as in files of older
/// programs. Throws as read_bias_sigma().
double read_half_width(const JsonNode& node);

/// Returns the member `sigma` of a compensator file. Throws std::runtime_error
/// for a number that is not finite.
nlohmann::ordered_json bias_sigma_json(const BiasSigma& sigma);

/// Reads it. Throws std::invalid_argument, naming file and key, for
/// - a key that is missing or not known, or a value of the wrong type;
/// - no temperatures, temperatures that do not increase or lie beyond absolute
///   zero, or another number of sigmas;
/// - a sigma, growth, time constant or factor that is not above 0 and finite,
///   and an amplitude that is below 0;
/// - a half-width below 0;
/// - a source or level that is not one.
BiasSigma read_bias_sigma(const JsonNode& node);

}  // namespace beamgyro::internal
