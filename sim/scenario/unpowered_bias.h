// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/memory/memory_trajectory.h"
#include "sim/scenario/filtered_motion.h"

namespace beamgyro::internal {

/// The bias of samples without power. A gyro without power has no output; its
/// bias there is the one that it would settle to at its temperatures, which is
/// what the quasi-static run computes at every sample.
class UnpoweredBias {
 public:
  /// The arguments must outlive the object; `memory` is null for a unit
  /// without.
  UnpoweredBias(const ScenarioPlan& scenario, const Gyro& gyro,
                const Motion& motion, const MemoryTrajectory* memory);

  /// Replaces the bias of the samples without power. The samples must follow
  /// those of the call before.
  void fill_next(RunSamples& samples);

 private:
  void fill_moving(const std::vector<std::size_t>& unpowered,
                   RunSamples& samples);
  void fill_still(const std::vector<std::size_t>& unpowered,
                  RunSamples& samples) const;

  const ScenarioPlan& scenario_;
  const Gyro& gyro_;
  const MemoryTrajectory* memory_;
  LockPath path_;
  std::optional<FilteredMotion> motion_;  // of axes other than the input axis
};

}  // namespace beamgyro::internal
