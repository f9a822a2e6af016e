// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "sim/campaign/campaign.h"
#include "validation/external/tested_compensator.h"
#include "validation/result/device_evidence.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// What a population is put through.
struct PopulationTask {
  const CampaignPlan* campaign;  // not owned, as everything here
  const Qualification* qualification;
  const SpecificationFile* specification;
  const TestedCompensator* compensator = nullptr;  // one for all, or
  const ModelSpec* model = nullptr;                // one trained on each
};

/// Simulates the devices of a campaign, one task each, and decides on every
/// limit of the specification for each. Runs that no limit reads are not
/// simulated. A device passes when every limit is met. A device that cannot be
/// simulated or trained on fails. The result does not depend on the number of
/// threads.
PopulationYield population_yield(const PopulationTask& task,
                                 std::size_t threads,
                                 const ProgressOfWork& progress = {});

}  // namespace beamgyro::internal
