// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "sim/dynamics/modal_table.h"
#include "sim/dynamics/spurious_bias.h"
#include "sim/scenario/filtered_motion.h"
#include "sim/scenario/sensing_noise.h"

namespace beamgyro::internal {

/// What the runs that simulate the loops have beside their integration: motion,
/// memory, the bias without power, noise and the recording.
class LoopRun {
 public:
  /// `scenario` and `gyro` must outlive the object.
  LoopRun(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
          const RunKey& key);

  const Motion& motion() const { return motion_; }
  /// Null for a unit without memory.
  const ModalMemory* memory() const { return added_ ? &*added_ : nullptr; }

  /// Returns the recording of the next samples, of which the integration has
  /// the signals, the temperatures and the bias.
  Recording block(RunSamples&& samples);

 private:
  // A gyro without power has no output; its bias there is the one that it would
  // settle to at its temperatures, which is what the quasi-static run computes
  // at every sample.
  void fill_unpowered_bias(RunSamples& samples);
  void fill_spurious_bias(RunSamples& samples);
  void fill_moving(const std::vector<std::size_t>& unpowered,
                   RunSamples& samples);
  void fill_still(const std::vector<std::size_t>& unpowered,
                  RunSamples& samples) const;

  const ScenarioPlan& scenario_;
  const TrimmedGyro& gyro_;
  Motion motion_;
  std::unique_ptr<MemoryTrajectory> memory_;
  std::optional<ModalMemory> added_;
  LockPath path_;
  std::optional<FilteredMotion> filtered_;  // with axes beside the input axis
  std::optional<SpuriousBias> spurious_;
  std::optional<SensingNoise> noise_;
  RunRecorder recorder_;
};

}  // namespace beamgyro::internal
