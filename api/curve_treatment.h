// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "include/beamgyro/curves.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument unless curves over these temperatures [degC]
/// can be treated so and described.
void check_treatment(std::span<const double> temperatures,
                     const CurveTreatment& treatment);

}  // namespace beamgyro::internal
