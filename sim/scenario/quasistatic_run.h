// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "dataset/recording.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"

namespace beamgyro {

/// Which random streams a run draws from, beside the seed of its scenario.
struct RunKey {
  std::uint32_t device = 0;
  std::uint32_t run = 0;
};

/// Quasi-static run (L1): the thermal network over time, the exact static
/// response (2.10) at the beam's temperature and the filtered rate, the board's
/// phase and offset (2.23), noise, saturation and ADC. Valid while temperature
/// and rate change slowly against the sense mode (27 ms) and the loops.
/// Fills every column of a recording (docs/formats.md) and `status`; the texts
/// and versions are the caller's.
Recording simulate_quasistatic(const Scenario& scenario, const Device& device,
                               const RunKey& key = {});

}  // namespace beamgyro
