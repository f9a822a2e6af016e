// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/compensator.h"
#include "compensation/run_source.h"
#include "dataset/recording.h"

namespace beamgyro {

/// SHA-256 of times, status and measured variables, these by name: what two
/// recordings have in common that differ only in attributes, in what a
/// simulator knows, or in a compensated rate.
std::string measured_sha256(const Recording& recording);

/// Whether training fitted the recording or held it out: its file, of
/// `file_sha256`, or another with the same measured_sha256().
bool was_used_in_training(const Provenance& provenance,
                          const std::string& file_sha256,
                          const Recording& recording);

/// Whether training used this run of a device of `set`, or, when it learned
/// from several devices, another run of the device: then the device is none
/// that the compensator never saw.
bool was_used_in_training(const Provenance& provenance, const SetPart& set,
                          const TrainingRun& run);

/// Whether the compensator was trained on `set` by a program that did not write
/// down on which of its devices.
bool may_have_used(const Provenance& provenance, const SetPart& set);

}  // namespace beamgyro
