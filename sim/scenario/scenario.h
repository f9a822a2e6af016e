// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/numerics/piecewise_linear.h"
#include "sim/scenario/rate_profile.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal {

enum class Fidelity {
  kQuasistatic,  // thermal network and static response at every sample
  kEnvelope,     // amplitudes, loops and thermal network over time
  kCarrier,      // every vibration
};

/// What happens to one gyro: power, surroundings and rotation over time.
struct ScenarioPlan {
  std::string name, description;
  std::filesystem::path device_file;
  Fidelity fidelity = Fidelity::kQuasistatic;
  double duration = 0;     // [s]
  double output_rate = 0;  // [Hz]
  std::uint64_t seed = 0;
  double age = 0;        // of the unit at time 0, since its factory trim [s]
  bool has_age = false;  // the file gives it, be it 0
  std::vector<PowerInterval> powered;
  PiecewiseLinear ambient = PiecewiseLinear::constant(298.15);  // [K]
  std::vector<double> soak_ends;  // [s], of an ambient that is made of soaks
  bool stirred = false;
  PerAxis<RateProfile> motion = no_motion();  // [rad/s] [m/s2]
  bool noise_enabled = true;
  // Temperatures before time 0 [K]; its last point is at time 0.
  std::optional<PiecewiseLinear> history;
};

/// Returns the name used in files: "quasistatic", "envelope", "carrier".
std::string_view fidelity_name(Fidelity fidelity);

/// Returns name and description, for a title; without a description that is
/// longer than a title.
std::string title_of(const ScenarioPlan& scenario);

/// Returns the number of samples, floor(duration x output_rate).
std::size_t sample_count(const ScenarioPlan& scenario);

/// time(k) = k / output_rate [s], k = 0 .. sample_count - 1.
SampleGrid sample_grid(const ScenarioPlan& scenario);

/// Returns the times of all samples.
std::vector<double> sample_times(const ScenarioPlan& scenario);

/// Returns the scenario with times that only rounding keeps apart
/// (is_same_time()) made equal. Power switches, jumps and bends of profiles at
/// the same time move together:
/// - to the sample at that time, if there is one;
/// - else to the number of nine decimals at that time;
/// - else to the last of them.
/// A single switch or jump moves likewise; a single bend stays. Two points of
/// one profile at the same time make a jump. Random motions have no points yet
/// and are not changed.
ScenarioPlan with_aligned_borders(const ScenarioPlan& scenario);

/// Returns the highest output rate [Hz] that a fidelity allows.
double highest_output_rate(Fidelity fidelity);

}  // namespace beamgyro::internal
