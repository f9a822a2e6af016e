// SPDX-License-Identifier: MIT
/// \file
/// Simulation of one gyro in one scenario.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "beamgyro/progress.h"
#include "beamgyro/recording.h"
#include "beamgyro/scenario.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

struct SimulationOptions {
  /// Fails where the drive loop is not locked one second after a power-on or
  /// later.
  bool stop_on_unlock = false;
  Progress progress = {};  ///< called after each block of samples
};

struct SimulatedRun {
  Recording recording;
  /// What the user of a run should know and no error says: saturation, samples
  /// without lock, aliasing, temperatures beyond those of the ceramic.
  std::vector<std::string> warnings;
};

/// Simulates a run and returns it in memory, with every text and version that a
/// file has: write_recording() makes the bytes that `beamgyro run` writes. The
/// samples depend on the scenario alone. Throws std::invalid_argument for an
/// output rate that the fidelity cannot give, std::runtime_error with the time
/// for a run that cannot go on, and Cancelled. Calls for any scenarios may run
/// at once.
SimulatedRun simulate(const Scenario& scenario,
                      const SimulationOptions& options = {});

/// Receives a run block by block: recordings with the same columns and texts,
/// whose samples follow each other.
using RecordingSink = std::function<void(Recording&& block)>;

/// The same for runs that are too long for memory. Returns the warnings. An
/// exception of `on_block` ends the run and reaches the caller.
std::vector<std::string> simulate_blocks(const Scenario& scenario,
                                         const RecordingSink& on_block,
                                         const SimulationOptions& options = {});

/// The same into a file, as write_recording() writes it; memory does not grow
/// with the run. Returns the warnings.
std::vector<std::string> simulate_to_file(
    const Scenario& scenario, const std::filesystem::path& path,
    const SimulationOptions& options = {});

}  // namespace beamgyro
