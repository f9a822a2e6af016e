// SPDX-License-Identifier: MIT
#pragma once

#include "sim/dynamics/gyro.h"
#include "sim/scenario/run_recorder.h"
#include "sim/scenario/scenario.h"

namespace beamgyro::internal {

/// Carrier run (L3): integrates every vibration (CarrierOde) by Fehlberg's
/// method of order 8, with an error below 1e-4 deg/s. The temperatures come
/// from the thermal network as in a quasi-static run and are held over
/// kCarrierTick. Everything else is as in simulate_envelope(). Throws
/// std::invalid_argument for an output rate above a quarter of the drive
/// frequency.
void simulate_carrier(const ScenarioPlan& scenario, const Gyro& gyro,
                      const RunKey& key, const BlockSink& on_block);

inline constexpr double kCarrierTick = 1e-3;  // [s]

/// Estimates the processor time [s] of simulate_carrier(), from the measured
/// cost of a powered second (bench/README.md).
double carrier_cost(const ScenarioPlan& scenario);

}  // namespace beamgyro::internal
