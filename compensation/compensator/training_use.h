// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Returns the SHA-256 of times, status and measured variables, sorted by name.
/// It is the same for recordings that differ only in attributes, truth or a
/// compensated rate.
std::string measured_sha256(const Recording& recording);

/// Returns whether training fitted the recording or held it out: the file with
/// `file_sha256`, another one with the same measured_sha256(), or one that
/// shares_stretches() with it.
bool was_used_in_training(const Provenance& provenance,
                          const std::string& file_sha256,
                          const Recording& recording);

/// Returns whether training used this run of a device of `set`. If training
/// learned from several devices, any run of the device counts, because the
/// device is known to the compensator then.
bool was_used_in_training(const Provenance& provenance, const TrainingSet& set,
                          const TrainingRun& run);

/// Returns whether the compensator was trained on `set` by an older program
/// that did not record on which devices.
bool may_have_used(const Provenance& provenance, const TrainingSet& set);

/// Returns a warning when the compensator names neither files nor a set that it
/// was trained on, so that no run can be told in-sample; else an empty text.
std::string warning_of_no_training(const Provenance& provenance);

}  // namespace beamgyro::internal
