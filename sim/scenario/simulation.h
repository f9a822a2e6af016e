// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

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
void simulate_quasistatic(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                          const RunKey& key, const BlockSink& on_block,
                          std::size_t block_samples = kBlockSamples);

/// Carrier run (L3): integrates every vibration (CarrierOde) by Fehlberg's
/// method of order 8, with an error below 1e-4 deg/s. The temperatures come
/// from the thermal network as in a quasi-static run and are held over
/// kCarrierTick. Everything else is as in simulate_envelope(). Throws
/// std::invalid_argument for an output rate above a quarter of the drive
/// frequency.
void simulate_carrier(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                      const RunKey& key, const BlockSink& on_block);

inline constexpr double kCarrierTick = 1e-3;  // [s]

/// Estimates the time [s] that simulate_carrier() takes here. A run of more
/// than a minute on the machine of bench/README.md is estimated from its first
/// second with power, which is simulated for it.
double carrier_cost(const ScenarioPlan& scenario, const TrimmedGyro& gyro);

/// Simulates a run at the fidelity of its scenario, block by block. Throws as
/// simulate_quasistatic(), simulate_envelope() and simulate_carrier().
void simulate(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
              const RunKey& key, const BlockSink& on_block);

/// Adds the next block to a recording that will have `samples`; the first one
/// becomes the recording.
void append_block(Recording& whole, Recording&& block, std::size_t samples);

/// Returns the whole recording in memory.
Recording simulated(const ScenarioPlan& scenario, const TrimmedGyro& gyro,
                    const RunKey& key = {});
Recording simulated(const ScenarioPlan& scenario,
                    const DeviceParameters& device, const RunKey& key = {});

}  // namespace beamgyro::internal
