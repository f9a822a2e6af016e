// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validation/qualification/qualification.h"
#include "validation/qualification/qualified_runs.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// Returns a sentence for each limit that the runs of a qualification cannot
/// decide, whatever the compensator: no run shows the metric, or a gyro without
/// an error of its own, with no more than the noise that the device states, is
/// undecided in two of three draws of that noise. Where the runs are at rest or
/// rate tables, the sentence says how many times as long they would have to be.
///
/// Left out, because they depend on more than the noise: limits relative to
/// another rate, of the sigma of a compensator, and of metrics that read rates
/// that move. Throws as qualified_runs().
std::vector<std::string> undecidable_limits(
    const Qualification& qualification, const QualifiedDevice& device,
    const SpecificationFile& specification, std::size_t threads);

}  // namespace beamgyro::internal
