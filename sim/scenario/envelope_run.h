// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Envelope run (L2): integrates the amplitudes of both modes, the drive loop,
/// the rebalance loop, demodulators, output filter and thermal network
/// (EnvelopeOde). A twin at rate 0 gives `true_bias`. Noise, saturation and ADC
/// follow as in every run. At each power-on the gyro starts at rest. `on_block`
/// receives the recording block by block, so memory does not grow with the run.
/// Throws as MaterialLimits and the integrator.
void simulate_envelope(const ScenarioPlan& scenario, const Gyro& gyro,
                       const RunKey& key, const BlockSink& on_block);
void simulate_envelope(const ScenarioPlan& scenario,
                       const DeviceParameters& device, const RunKey& key,
                       const BlockSink& on_block);

}  // namespace beamgyro::internal
