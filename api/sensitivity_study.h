// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "include/beamgyro/campaign.h"
#include "include/beamgyro/sensitivity.h"
#include "sensitivity/study/device_sample.h"

namespace beamgyro::internal {

/// Returns the names of all figures of merit.
std::vector<std::string> merit_names();

/// sensitivity() with counts that other threads may read.
SensitivityResult studied(const Campaign& campaign,
                          const SensitivityOptions& options,
                          DeviceSampleCounts& counts);

}  // namespace beamgyro::internal
