// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "validation/qualification/qualification.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// Returns whether a metric reads a run of that name and purpose.
bool reads_run(const Metric& metric, const MetricRuns& runs,
               const std::string& name, RunPurpose purpose);

/// Decides on every limit of a specification, and whether the recorded rate
/// meets it, too. A limit relative to the recorded rate asks nothing of that.
std::vector<DecidedLimit> decided_limits(
    const SpecificationFile& specification,
    const std::vector<MetricResult>& metrics,
    const std::vector<OwnMetricResult>& own_metrics = {});

}  // namespace beamgyro::internal
