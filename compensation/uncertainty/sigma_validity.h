// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "dataset/files/json_node.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Which way a temperature goes.
enum class TemperatureWay { kRising, kFalling };

std::string way_name(TemperatureWay way);  // "rising", "falling"

/// A temperature goes one way when it moves by this much without turning back
/// by as much.
constexpr double kLeastWay = 10.0;  // [K]

/// Sigma of units that age is taken to hold for as long after the oldest of its
/// runs: a week, in which slow noise has forgotten itself.
constexpr double kSigmaLifetime = 168.0;  // [h]

/// What the runs behind a sigma have shown beside temperatures. Sigma says
/// nothing of what they have not.
struct SigmaValidity {
  // The one way that their temperatures went, of a gyro that may remember.
  std::optional<TemperatureWay> only_way = {};
  // [h], largest age of the units, if they age or remember as the runs state.
  std::optional<double> age = {};

  bool operator==(const SigmaValidity&) const = default;
};

/// Returns whether a gyro may have hysteresis: its recording states no device,
/// or one with the table [memory].
bool may_remember(const Recording& recording);

/// Returns the age [h] that the scenario of a recording states for a unit that
/// ages or remembers, 0 where it does not say, or nothing for other units.
std::optional<double> stated_age(const Recording& recording);

/// Returns why a sigma does not hold of a recording, a sentence for each
/// reason: temperatures that go the other way, and an age beyond
/// kSigmaLifetime.
std::vector<std::string> reasons_against_sigma(const SigmaValidity& validity,
                                               const Recording& recording);

/// Returns the member `holds_for` of a sigma; null where there is nothing to
/// say.
nlohmann::ordered_json sigma_validity_json(const SigmaValidity& validity);

/// Reads it. Throws std::invalid_argument for a key that is not known, a way
/// that is none, and an age below 0.
SigmaValidity read_sigma_validity(const JsonNode& node);

}  // namespace beamgyro::internal
