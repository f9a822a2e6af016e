// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Hashes of stretches of a recording, ascending. A stretch is 32 powered
/// samples in a row.
using MeasuredSketch = std::vector<std::uint64_t>;

constexpr std::size_t kSketch = 32;  // hashes

/// Returns the least `most` hashes of the stretches of a recording, or nothing
/// when it has fewer than kSketch. A hash depends on `rate` and `temperature`,
/// not on the time, and is the same for a stretch turned round. Stretches whose
/// rate changes less than 16 times do not count: without noise recordings of
/// different days share them. Throws std::invalid_argument for a recording
/// without rate or temperature.
MeasuredSketch measured_sketch(const Recording& recording,
                               std::size_t most = kSketch);

/// Returns all hashes of a recording up to `limit`, ascending. Throws as
/// measured_sketch().
std::vector<std::uint64_t> stretches_up_to(std::uint64_t limit,
                                           const Recording& recording);

/// Returns whether half or more of the stretches of a recording are also
/// stretches of the one that `sketch` was made of: a part of it, turned round,
/// moved in time, or changed here and there. `stretches` are stretches_up_to()
/// the last of the sketch or more, or the sketch of that recording. Of a part
/// with fewer than 8 hashes below the last of the sketch nothing is found: a
/// part below a quarter of what a sketch of kSketch hashes was made of.
bool shares_stretches(const MeasuredSketch& sketch,
                      const std::vector<std::uint64_t>& stretches);

}  // namespace beamgyro::internal
