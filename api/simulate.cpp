// SPDX-License-Identifier: MIT
#include "include/beamgyro/simulate.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "api/program_version.h"
#include "api/reported_progress.h"
#include "api/scenario_state.h"
#include "dataset/netcdf/recording_file.h"
#include "sim/scenario/drive_lock.h"
#include "sim/scenario/run_warnings.h"
#include "sim/scenario/simulation.h"

namespace beamgyro {
namespace {

// Writes where a run comes from into its recording.
void stamp(const internal::LoadedScenario& input, Recording& recording) {
  recording.program_version = internal::kProgramVersion;
  recording.git_revision = internal::kGitRevision;
  recording.title = internal::title_of(input.scenario);
  recording.history = internal::history_line("run");
  recording.scenario_text = input.scenario_text;
  recording.device_text = input.device_text;
  recording.overrides_text = input.overrides_text;
}

}  // namespace

std::vector<std::string> simulate_blocks(const Scenario& scenario,
                                         const RecordingSink& on_block,
                                         const SimulationOptions& options) {
  if (!on_block)
    throw std::invalid_argument("no function for the blocks; expected one");
  const internal::ScenarioState& state = scenario.content();
  const internal::LoadedScenario& input = state.loaded;
  const auto samples = static_cast<double>(scenario.samples());
  internal::RunWarnings warnings(input.scenario, input.device);
  std::size_t done = 0;
  internal::simulate(
      input.scenario, state.gyro.of(input.device), {}, [&](Recording&& block) {
        if (options.stop_on_unlock)
          internal::require_lock(input.scenario, block);
        stamp(input, block);
        warnings.add(block);
        done += block.time.size();
        on_block(std::move(block));
        internal::report(options.progress, static_cast<double>(done) / samples);
      });
  return warnings.texts();
}

SimulatedRun simulate(const Scenario& scenario,
                      const SimulationOptions& options) {
  SimulatedRun run;
  run.warnings = simulate_blocks(
      scenario,
      [&](Recording&& block) {
        internal::append_block(run.recording, std::move(block),
                               scenario.samples());
      },
      options);
  return run;
}

std::vector<std::string> simulate_to_file(const Scenario& scenario,
                                          const std::filesystem::path& path,
                                          const SimulationOptions& options) {
  std::optional<internal::RecordingFile> file;
  std::vector<std::string> warnings = simulate_blocks(
      scenario,
      [&](Recording&& block) {
        if (!file) file.emplace(block, scenario.samples(), path);
        file->append(block);
      },
      options);
  file->finish();
  return warnings;
}

}  // namespace beamgyro
