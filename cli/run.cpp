// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "dataset/files/atomic_file.h"
#include "dataset/netcdf/recording_file.h"
#include "sim/scenario/carrier_run.h"
#include "sim/scenario/run_warnings.h"
#include "sim/scenario/simulation.h"
#include "sim/scenario/simulation_input.h"

namespace beamgyro {
namespace {

struct RunArguments {
  std::string scenario, output;
  std::vector<std::string> overrides;
  std::optional<std::int64_t> seed;
  std::optional<std::string> fidelity;
  bool yes = false;
};

// A run that will take longer needs --yes [s].
constexpr double kLongRun = 3600;

void require_consent(const Scenario& scenario, bool yes) {
  if (scenario.fidelity != Fidelity::kCarrier) return;
  const double cost = carrier_cost(scenario);
  if (cost <= kLongRun || yes) return;
  throw std::invalid_argument(fmt::format(
      "a carrier run of {:g} s would take about {:.1f} h here; pass --yes to "
      "start it, or use the envelope fidelity",
      scenario.duration, cost / 3600));
}

int run(const RunArguments& arguments) {
  require_recording_name(arguments.output);
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.seed)
    overrides.push_back(fmt::format("seed={}", *arguments.seed));
  if (arguments.fidelity)
    overrides.push_back(fmt::format("fidelity=\"{}\"", *arguments.fidelity));
  const LoadedScenario input = load_scenario(arguments.scenario, overrides);
  require_output(arguments.output, input.files);
  require_consent(input.scenario, arguments.yes);

  const std::size_t samples = sample_count(input.scenario);
  std::size_t done = 0;
  Progress progress("simulating " + arguments.scenario);
  std::optional<RecordingFile> file;
  RunWarnings warnings(input.scenario, input.device);
  const Gyro gyro = make_gyro(input.device);
  simulate(input.scenario, gyro, {}, [&](Recording&& block) {
    if (!file) {
      block.program_version = kProgramVersion;
      block.git_revision = kGitRevision;
      block.title = title_of(input.scenario);
      block.history = history_line("run");
      block.scenario_text = input.scenario_text;
      block.device_text = input.device_text;
      block.overrides_text = input.overrides_text;
      file.emplace(block, samples, arguments.output);
    }
    file->append(block);
    warnings.add(block);
    done += block.time.size();
    progress.set_share(static_cast<double>(done) /
                       static_cast<double>(samples));
  });
  file->finish();
  for (const std::string& warning : warnings.texts())
    keep_warning(fmt::format("{}: {}", arguments.scenario, warning));
  return 0;
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command =
      program.add_subcommand("run", "Simulate one gyro in one scenario");
  command->add_option("scenario", arguments->scenario, "SCENARIO.toml")
      ->required();
  command->add_option("-o,--output", arguments->output, "RUN.h5 or RUN.csv")
      ->required();
  command
      ->add_option("--set", arguments->overrides,
                   "KEY=VALUE replaces a key of the scenario or of its device; "
                   "may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--seed", arguments->seed,
                   "Replaces the seed of the scenario")
      ->check(CLI::NonNegativeNumber);
  command->add_option(
      "--fidelity", arguments->fidelity,
      "Replaces the fidelity: quasistatic, envelope or carrier");
  command->add_flag(
      "--yes", arguments->yes,
      "Starts a carrier run even if it will take more than an hour");
  command->callback([arguments, &action] {
    action = [arguments] { return run(*arguments); };
  });
}

}  // namespace beamgyro
