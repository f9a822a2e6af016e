// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/units.h"
#include "tests/compensation/recorded_run.h"
#include "validation/metrics/metric.h"
#include "validation/metrics/rate_noise_model.h"

namespace beamgyro::internal {

/// A run of a gyro whose signals are known, with noise that its device states.
struct SceneRun {
  RunPurpose purpose = RunPurpose::kRest;
  RecordedRun signals = {};
  // true_* columns beside the rate.
  std::map<std::string, SignalOfTime> truths = {};
};

/// Runs that metrics are evaluated on; the judged rate is the recorded one.
class Scene {
 public:
  Scene() = default;
  explicit Scene(const SceneRun& run, const NoiseLevels& noise = {},
                 std::uint64_t seed = 0) {
    add(run, noise, seed);
  }

  /// Adds a run with noise from the streams of `seed`. Without noise the
  /// recording has no device file.
  EvidenceRun& add(const SceneRun& run, const NoiseLevels& noise = {},
                   std::uint64_t seed = 0);
  EvidenceRun& add(RunPurpose purpose, Recording recording);

  Evidence evidence;

 private:
  std::vector<std::unique_ptr<Recording>> recordings_;
};

/// The noise of the nominal device.
inline constexpr NoiseLevels kNominalNoise = {0.01, 0.01, 2e-4, 0.03};

/// Evaluates a metric by its name. Fails the test when there is none.
Estimate evaluated(const std::string& metric, const Evidence& evidence);

/// Soaks of `hold` [s] at each temperature, joined by slopes of 300 s.
SignalOfTime soak_temperatures(std::vector<double> temperatures, double hold);

/// 600 s at -20 degC, then 1 K/min to 40 degC and, after 10 minutes there,
/// back.
double ramp_temperature(double t);

/// Eleven rates over +-100 deg/s, up and down, 20 s each.
double table_rate(double t);

/// Each axis in turn up and down four times, 60 s each. The bias is 0.3 deg/s,
/// drifts by `drift` [deg/s/s], and follows the acceleration of each axis by
/// `sensitivities` [deg/s/g].
SceneRun tumble_run(double drift, const std::array<double, 3>& sensitivities);

}  // namespace beamgyro::internal
