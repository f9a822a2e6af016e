// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

#include "compensation/rows/run_source.h"
#include "validation/result/recorded_evidence.h"
#include "validation/result/validation_result.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// The verdict on the devices of a set.
struct SetVerdicts {
  PopulationYield devices;
  // Of the first device with the worst verdict; its words name it. What is
  // found of a sigma is of all devices, each of them a cluster.
  ValidationResult shown;
  DeviceEvidence evidence;
};

/// Takes the evidence of each device in turn.
using EvidenceVisitor = std::function<void(const DeviceEvidence&)>;

/// Judges a compensator on every device of a set, one after the other, with the
/// runs of one device in memory. A device passes when every limit and check is
/// met. Throws as recorded_evidence(), and std::invalid_argument without runs.
SetVerdicts set_verdicts(const RunSource& set,
                         const RecordedAnswering& answering,
                         const SpecificationFile& specification,
                         std::size_t threads,
                         const ProgressOfWork& progress = {},
                         const EvidenceVisitor& on_device = {});

}  // namespace beamgyro::internal
