// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "validation/external/tested_compensator.h"
#include "validation/result/device_evidence.h"

namespace beamgyro {

/// Reads recordings (.h5 or .csv) and answers them. Each shows its
/// recorded_purpose(); one at rest is read from kRestBegins on. The baseline
/// "cubic" is the one in the file of the compensator, `known`, which is null
/// for a library or a command. Without `full_scale` [deg/s] it is that of the
/// first recording which tells it, else kFullScale. Throws
/// std::invalid_argument that names a recording which cannot be read, or has no
/// true_rate.
DeviceEvidence recorded_evidence(const std::vector<std::filesystem::path>& runs,
                                 const TestedCompensator& compensator,
                                 const Compensator* known,
                                 std::optional<double> full_scale,
                                 std::size_t threads);

}  // namespace beamgyro
