// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

namespace beamgyro::internal {

/// Throws std::invalid_argument for no temperatures, and OptionError for one
/// that the materials do not stand or that is not finite [degC].
void require_material_temperatures(std::span<const double> temperatures);

/// Returns a warning, in a list of none or one, when a temperature [degC] lies
/// where the ceramic's coefficients are no longer linear. `name` is that of
/// the device or campaign.
std::vector<std::string> ceramic_warnings(std::span<const double> temperatures,
                                          const std::string& name);

}  // namespace beamgyro::internal
