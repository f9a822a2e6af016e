// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compensation/inputs/features.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// What a run of a qualification shows.
enum class RunPurpose {
  kSoak,        // "soak": plateaus of ambient temperature, upwards or downwards
  kRamp,        // "ramp": ambient temperature at a constant slope
  kWarmUp,      // "warm_up": power-on from cold at a constant ambient
  kPowerCycle,  // "power_cycle": several power-ons with full cool-down between
  kRateTable,   // "rate_table": steps of constant rate
  kConstantRate,  // "constant_rate": a rate held for minutes
  kSineRate,      // "sine_rate"
  kRateStep,      // "rate_step"
  kRest,          // "rest": powered long before, constant ambient, no rate
  kTumble,        // "tumble": gravity along each axis in turn
  kRandomRate,    // "random_rate"
  kVibration,     // "vibration": acceleration, or cross rates, that change
};

/// Returns the name used in files, as in the comments above.
std::string_view purpose_name(RunPurpose purpose);

/// Returns the purpose of that name, or nothing.
std::optional<RunPurpose> purpose_of(std::string_view name);

/// A run and the rate that is judged by it: the recorded rate (before) or that
/// of a compensator (after).
struct EvidenceRun {
  std::string name;
  RunPurpose purpose = RunPurpose::kSoak;
  const Recording* recording = nullptr;  // not owned; with its true_rate
  std::vector<double> rate;              // [deg/s], one per time; NaN: none
  // Samples outside what training saw, where that is known.
  std::optional<std::size_t> clamped = {};
  // [deg/s], stated 1-sigma of the bias of each rate; empty: none.
  std::vector<double> sigma = {};
};

/// What metrics are evaluated on. Metrics see truth; compensators never do.
struct Evidence {
  std::vector<EvidenceRun> runs;
  double full_scale = 150.0;  // [deg/s]
};

/// Returns the runs with one of these purposes.
std::vector<const EvidenceRun*> runs_for(
    const Evidence& evidence, const std::vector<RunPurpose>& purposes);

/// Returns the purposes of runs without a rate, or with one that is held for
/// minutes.
std::vector<RunPurpose> quiet_purposes();

/// Returns the lowest and highest measured temperature [degC] of the powered
/// samples of the runs; nothing where a run has none.
std::optional<TemperatureRange> temperatures_of(
    const std::vector<const Recording*>& runs);

}  // namespace beamgyro::internal
