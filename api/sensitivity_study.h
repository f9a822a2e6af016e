// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "include/beamgyro/sensitivity.h"
#include "sensitivity/study/device_sample.h"

namespace beamgyro::internal {

/// Returns the names of all figures of merit.
std::vector<std::string> merit_names();

/// Returns the sample that a study takes. Throws as sensitivity().
DeviceSampleOptions sample_options(const beamgyro::Campaign& campaign,
                                   const SensitivityOptions& options);

/// sensitivity() with counts that other threads may read.
SensitivityResult sensitivity_study(const beamgyro::Campaign& campaign,
                                    const SensitivityOptions& options,
                                    DeviceSampleCounts& counts);

}  // namespace beamgyro::internal
