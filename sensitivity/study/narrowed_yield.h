// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sensitivity/study/device_sample.h"
#include "sensitivity/study/sensitivity_study.h"

namespace beamgyro::internal {

/// A yield of a sample, and where its devices come from.
struct NarrowingStudy {
  const CampaignPlan& campaign;
  // Of the sample, with the figure of the yield as their first.
  const DeviceSampleOptions& options;
  const std::vector<std::string>& keys;  // DeviceSample::keys
};

/// Tolerances of which pairs and widths are tried: those whose half helps most.
constexpr std::size_t kHelpful = 5;

/// Adds the yields with two tolerances halved at once: of all pairs of the
/// kHelpful tolerances that help most by themselves.
void add_pairs(YieldResult& yield, const NarrowingStudy& study,
               DeviceSampleCounts& counts);

/// Adds how narrow one tolerance has to be for the yield `target`, of each of
/// the kHelpful that help most. The yield is computed at every eighth of the
/// width down to kNarrowest, and is taken to be straight between.
void add_needed(YieldResult& yield, double target, const NarrowingStudy& study,
                DeviceSampleCounts& counts);

}  // namespace beamgyro::internal
