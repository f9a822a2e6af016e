// SPDX-License-Identifier: MIT
#pragma once

#include "dataset/recording.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Quasi-static run (L1): the thermal network over time, the exact static
/// response (2.10) at the beam's temperature and the filtered rate, the board's
/// phase and offset (2.23), noise, saturation and ADC. Cross rates and
/// accelerations act through the exact solution at every sample. Valid while
/// temperature and rate change slowly against the sense mode (27 ms) and the
/// loops. Fills every column of a recording (docs/formats.md) and `status`; the
/// texts and versions are the caller's.
Recording simulate_quasistatic(const Scenario& scenario, const Gyro& gyro,
                               const RunKey& key = {});
Recording simulate_quasistatic(const Scenario& scenario, const Device& device,
                               const RunKey& key = {});

}  // namespace beamgyro
