// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Quasi-static run (L1). It integrates the thermal network and takes the exact
/// static response (2.10) at the beam's temperature and the filtered rate, then
/// phase and offset of the board (2.23), noise, saturation and ADC. Cross rates
/// and accelerations act through the exact solution at every sample. It is
/// valid while temperature and rate change slowly compared with the sense mode
/// (27 ms) and the loops. `on_block` receives the recording block by block,
/// with every column (docs/reference/recording.md) and `status`, so memory does
/// not grow with the samples. The recording does not depend on the size of the
/// blocks. Throws std::invalid_argument for a scenario of another fidelity.
void simulate_quasistatic(const ScenarioPlan& scenario, const Gyro& gyro,
                          const RunKey& key, const BlockSink& on_block,
                          std::size_t block_samples = kBlockSamples);

}  // namespace beamgyro::internal
