// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// What tells a run from others.
struct RunMark {
  SourceFile file;     // its sketch has more hashes than files keep
  std::string origin;  // of a run without noise: the texts that it was made of
};

RunMark mark_of(const TrainingRun& run);

/// Returns the seed of the noise and of the turn-on offset of a recording.
/// Nothing for logs, for runs without noise, and for runs of a set, which share
/// the seed of their campaign and nothing else.
std::optional<std::uint64_t> noise_seed(const Recording& recording);

/// Returns whether two files are one, or hold the same measurements.
bool is_same_recording(const SourceFile& a, const SourceFile& b);

/// Returns whether half or more of the samples of `part` are those of `whole`
/// (shares_stretches()).
bool is_part_of(const SourceFile& part, const SourceFile& whole);

/// Throws std::invalid_argument that names both when a run is_same_recording()
/// or is_part_of() another one, be they trained on or held out. Runs without
/// noise are equal wherever their conditions are, so parts of them count within
/// one scenario only.
void require_different_runs(const std::vector<RunMark>& training,
                            const std::vector<RunMark>& held_out = {});

/// Returns a warning of runs that have the seed of their noise in common and
/// are scored as unseen by a fit to the others, or an empty text. Held-out runs
/// are scored so, and training runs if they are `cross_validated`.
std::string warning_of_shared_seeds(const std::vector<SourceFile>& training,
                                    const std::vector<SourceFile>& held_out,
                                    bool cross_validated);

/// Returns what is to be said of a recording that training did not use, but
/// that has the noise_seed() of a run that it used; else an empty text.
std::string shared_seed(const Provenance& provenance, const std::string& name,
                        const Recording& recording);

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

/// Returns whether training is known to have used one device alone, another one
/// than that of the recording.
bool is_of_another_device(const Provenance& provenance,
                          const Recording& recording);

/// The same of the devices that are selected of `set`.
bool is_of_other_devices(const Provenance& provenance, const TrainingSet& set);

/// Returns whether the compensator was trained on `set` by an older program
/// that did not record on which devices.
bool may_have_used(const Provenance& provenance, const TrainingSet& set);

/// Returns a warning when the compensator names neither files nor a set that it
/// was trained on, so that no run can be told in-sample; else an empty text.
std::string warning_of_no_training(const Provenance& provenance);

}  // namespace beamgyro::internal
