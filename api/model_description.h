// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "fmu/variables.h"

namespace beamgyro::internal {

/// The name of the binary inside an FMU, without its ending.
inline constexpr const char* kFmuIdentifier = "beamgyro_fmu";

/// Returns modelDescription.xml of a device, in the schema of FMI 2.0 or 3.0.
/// `name` is that of the model.
std::string model_description(const PackedDevice& device, FmiVersion version,
                              const std::string& name);

/// Returns the element of UnitDefinitions for a unit of recordings or of a key,
/// "degree/s/K". It has its factor and exponents of base units unless they are
/// no whole numbers, as of sqrt(s).
std::string unit_definition(const std::string& unit);

}  // namespace beamgyro::internal
