// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compensation/compensator/run_comparison.h"
#include "compensation/inputs/input.h"
#include "compensation/rows/run_source.h"
#include "compensation/rows/training_rows.h"

namespace beamgyro::internal {

/// Facts about the runs that are kept besides their rows.
struct RunFacts {
  std::vector<RunMark> runs;
  double coarsest_resolution = 0.0;  // [K], of the temperature
  double longest = 0.0;              // [s], of the recordings
  double shortest_step = HUGE_VAL;   // [s], of their samples
  std::set<std::string> devices;     // simulated ones, by stated_device()
  bool states_devices = true;        // every run
  bool may_remember = false;         // a device
  std::optional<double> age;         // [h], of the oldest unit, by stated_age()
};

/// Returns the same runs and notes facts about each as it passes. `facts` must
/// outlive the source.
RunSource noting(const RunSource& runs, RunFacts& facts);

/// Throws std::invalid_argument for a rate that is the truth in every row: a
/// channel that is not connected.
void require_bias(const TrainingRows& rows);

/// Throws std::invalid_argument for a filter that is a hundred times as long as
/// the longest recording, so that it stays where it starts, or a hundredth of
/// the step of its samples, so that it is what it filters.
void require_filters(const std::vector<Input>& inputs, const RunFacts& facts);

/// Returns a sentence for recordings of several devices, of which one
/// compensator cannot be right. Empty for a set or a population, which
/// have them on purpose.
std::string warning_of_devices(const RunFacts& facts, bool is_population);

}  // namespace beamgyro::internal
