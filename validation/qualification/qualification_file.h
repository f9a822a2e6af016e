// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "validation/qualification/qualification.h"

namespace beamgyro::internal {

/// Reads a qualification and its scenarios
/// (docs/reference/qualification_file.md). Scenarios are named relative to the
/// folder of the file. Throws std::invalid_argument "file:line:column: key:
/// ..." for
/// - a key, type or value that is not allowed, or an unknown key;
/// - a scenario that is missing or wrong, also one that an override makes so;
/// - a distribution of `vary` that is wrong, or whose choices or median are;
/// - two runs of one name;
/// - two runs of one seed whose noise is on, because they would have the same
///   noise;
/// - a metric that does not exist, or a run of [metrics] that does not exist or
///   has a purpose that the metric does not read.
Qualification read_qualification(const std::filesystem::path& file);

}  // namespace beamgyro::internal
