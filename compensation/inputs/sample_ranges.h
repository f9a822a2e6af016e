// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Consecutive samples of a recording: indices begin <= k < end.
struct SampleRange {
  std::size_t begin;
  std::size_t end;

  std::size_t size() const { return end - begin; }
  bool operator==(const SampleRange&) const = default;
};

constexpr double kScoreBlock = 60.0;       // [s]
constexpr double kPlateauTolerance = 0.5;  // [K]
constexpr double kLongestStep = 1.5;  // [-], usual steps; a longer one is a gap

/// Returns the median step of `time` [s], or 0 with fewer than two samples.
double usual_step(const Recording& recording);

/// Returns every stretch of powered samples, from a power-on to the next loss
/// of power. A gap in time does not end a stretch. Throws std::invalid_argument
/// unless `status` has one entry per time.
std::vector<SampleRange> powered_stretches(const Recording& recording);

/// Returns blocks of `length` [s], counted from each power-on: sample k of a
/// stretch that starts at t_0 belongs to block floor((t_k - t_0) / length). A
/// block with less than half of its samples, mostly the last one of a stretch,
/// is left out. In a stretch that fills no block, being short or sampled in
/// bursts, half of the samples of its fullest block are enough.
std::vector<SampleRange> score_blocks(const Recording& recording,
                                      double length = kScoreBlock);

/// Divides each powered stretch into pieces. A piece ends where the measured
/// temperature has moved by kPlateauTolerance from its first sample. Without a
/// column `temperature` a stretch is one piece.
std::vector<SampleRange> temperature_plateaus(const Recording& recording);

}  // namespace beamgyro::internal
