// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Envelope run (L2): amplitudes of both modes, drive loop, rebalance loop,
/// demodulators, output filter and thermal network over time (EnvelopeOde), and
/// its rate-0 twin for `true_bias`; then noise, saturation and ADC as in every
/// run. Starts at rest at each power-on. `on_block` takes the recording block
/// by block, so that memory does not grow with the run. Throws
/// SimulationFailure when the drive loop does not lock.
void simulate_envelope(const Scenario& scenario, const Gyro& gyro,
                       const RunKey& key, const BlockSink& on_block);
void simulate_envelope(const Scenario& scenario, const Device& device,
                       const RunKey& key, const BlockSink& on_block);

}  // namespace beamgyro
