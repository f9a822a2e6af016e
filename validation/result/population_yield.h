// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/campaign/campaign.h"
#include "validation/external/tested_compensator.h"
#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// Counts verdicts; there must be one.
VerdictCount count_of(std::span<const Verdict> verdicts);

/// Returns the metrics whose figures are kept of every device or seed: the
/// residual and those with a limit, without figures yet.
std::vector<PopulationMetric> followed_metrics(
    const SpecificationFile& specification);

/// Adds the figures of a result to them.
void add_figures(const ValidationResult& result,
                 std::vector<PopulationMetric>& metrics);

/// What a population is put through.
struct PopulationTask {
  const CampaignPlan* campaign;  // not owned, as everything here
  const Qualification* qualification;
  const SpecificationFile* specification;
  const TestedCompensator* compensator = nullptr;  // one for all, or
  const ModelSpec* model = nullptr;                // one trained on each
  const FittedCompensator* known = nullptr;  // `compensator` as it was trained
};

/// Simulates the devices of a campaign, one task each, and decides on every
/// limit of the specification for each. Runs that no limit reads are not
/// simulated. A device passes when every limit is met. A device that cannot be
/// simulated, whose drive loop never locks in a stretch of power of 10 s or
/// more, or that the model cannot be trained on, fails, as one does on which
/// the compensator is of no use or has no effect. The words of a device that
/// does not pass name its first limit that decided: one that is not met, or
/// else one that is undecided. The result does not depend on the number of
/// threads. Throws what else a device throws.
PopulationYield population_yield(const PopulationTask& task,
                                 std::size_t threads,
                                 const ProgressOfWork& progress = {});

}  // namespace beamgyro::internal
