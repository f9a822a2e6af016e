// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sensitivity/figures/figure_of_merit.h"
#include "sensitivity/study/device_sample.h"
#include "sensitivity/study/sensitivity_study.h"

namespace beamgyro::internal {

/// What a study was made of, for its first lines.
struct StudyHead {
  std::string campaign;
  std::uint64_t seed = 0;
  CurveGrid grid;
};

/// Returns what was sampled, and how many devices do not work, in two lines.
std::string sample_lines(const DeviceSample& sample, const StudyHead& head);

/// Returns the table of the indices of one figure, what their sum says in
/// words, and the yields where a limit was given.
std::string sensitivity_table(const MeritResult& result);

/// {"campaign", "seed", "range_degC", "devices", "failures", "first_failure",
/// "figures": {NAME: {"of", "samples", "indices": [{"key", "first",
/// "first_interval", "total", "total_interval", ...}, ...], ...}, ...}}
nlohmann::ordered_json to_json(const DeviceSample& sample,
                               const StudyHead& head,
                               const std::vector<MeritResult>& results);

}  // namespace beamgyro::internal
