// SPDX-License-Identifier: MIT
#include "validation/qualification/qualified_runs.h"

#include <fmt/format.h>

#include "parallel/work_queue.h"
#include "sim/dynamics/gyro.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {

std::vector<Recording> qualified_runs(const std::vector<QualificationRun>& runs,
                                      const QualifiedDevice& device,
                                      std::size_t threads,
                                      const std::function<void()>& on_done) {
  const TrimmedGyro gyro = make_gyro(device.device);
  std::vector<Recording> recordings(runs.size());
  for_each_task(runs.size(), threads, [&](std::size_t k, std::size_t) {
    const QualificationRun& run = runs[k];
    Recording& recording = recordings[k];
    try {
      recording = simulated(run.scenario, gyro, {device.number, 0});
    } catch (const SimulationFailure& error) {
      throw SimulationFailure(
          fmt::format("run {}: {}", run.name, error.what()));
    }
    recording.title = title_of(run.scenario);
    recording.scenario_text = run.scenario_text;
    recording.device_text = device.text;
    recording.overrides_text = run.overrides_text + device.overrides;
    if (on_done) on_done();
  });
  return recordings;
}

}  // namespace beamgyro::internal
