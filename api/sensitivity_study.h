// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "include/beamgyro/campaign.h"
#include "include/beamgyro/sensitivity.h"
#include "sensitivity/figures/figure_of_merit.h"
#include "sensitivity/study/device_sample.h"

namespace beamgyro::internal {

/// Returns the names of all figures of merit.
std::vector<std::string> merit_names();

/// A study whose options were checked.
struct SensitivityStudy {
  const Campaign& campaign;  // not owned
  DeviceSampleOptions sample;
  std::map<Merit, double> limits;  // largest magnitudes that are good
  bool linear = false;             // no logarithms

  std::uint64_t devices() const;  // that will be computed
};

/// Returns the study of the options. Throws as sensitivity().
SensitivityStudy checked_study(const Campaign& campaign,
                               const SensitivityOptions& options);

/// sensitivity() with counts that other threads may read.
SensitivityResult run_study(const SensitivityStudy& study,
                            DeviceSampleCounts& counts);

}  // namespace beamgyro::internal
