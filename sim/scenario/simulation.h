// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Simulates a run at the fidelity of its scenario, block by block. Throws as
/// simulate_quasistatic(), simulate_envelope() and simulate_carrier().
void simulate(const ScenarioPlan& scenario, const Gyro& gyro, const RunKey& key,
              const BlockSink& on_block);

/// Adds the next block to a recording that will have `samples`; the first one
/// becomes the recording.
void append_block(Recording& whole, Recording&& block, std::size_t samples);

/// Returns the whole recording in memory.
Recording simulated(const ScenarioPlan& scenario, const Gyro& gyro,
                    const RunKey& key = {});
Recording simulated(const ScenarioPlan& scenario,
                    const DeviceParameters& device, const RunKey& key = {});

}  // namespace beamgyro::internal
