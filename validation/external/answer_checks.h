// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "validation/external/tested_compensator.h"

namespace beamgyro::internal {

/// Answers the run twice in one process with a reset between. Returns a fault
/// kKeepsState when a bit of an answer differs; nothing when all are the same,
/// or when one of the answers has a fault of its own.
std::optional<SeenFault> state_kept_over_reset(
    const TestedCompensator& compensator, const Recording& run);

/// Answers the run as it is, cut off after a third and after 0.7 of its powered
/// samples, and with every measured variable changed after two thirds and after
/// 0.15. Returns a fault
/// kUsesLaterSamples when a bit of an answer before the cut or the change
/// differs; nothing otherwise, or when one of the answers has a fault of its
/// own.
std::optional<SeenFault> later_samples_used(
    const TestedCompensator& compensator, const Recording& run);

/// The difference between the answers of two compensators.
struct AnswerDifference {
  double largest = 0.0;     // [deg/s]
  double rms = 0.0;         // [deg/s]
  std::size_t at = 0;       // the sample with the largest
  std::size_t samples = 0;  // that both answer with a finite number
};

/// Compares two answers to the same run, as those of exported firmware with
/// those of the compensator file that it was exported from.
AnswerDifference difference_of(const Answer& one, const Answer& other);

}  // namespace beamgyro::internal
