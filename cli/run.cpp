// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/version.h"
#include "dataset/atomic_file.h"
#include "dataset/csv_file.h"
#include "dataset/hdf5_file.h"
#include "sim/scenario/carrier_run.h"
#include "sim/scenario/envelope_run.h"
#include "sim/scenario/quasistatic_run.h"

namespace beamgyro {
namespace {

struct RunArguments {
  std::string scenario, output;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> fidelity;
  bool yes = false;
};

bool is_csv(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension != ".h5" && extension != ".csv") {
    throw std::invalid_argument(
        fmt::format("-o {}: unknown kind of file \"{}\"; expected a name that "
                    "ends in .h5 or .csv",
                    path.string(), extension));
  }
  return extension == ".csv";
}

// Above this a run says what it costs before it starts [s].
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

Recording simulate(const Scenario& scenario, const Device& device) {
  switch (scenario.fidelity) {
    case Fidelity::kEnvelope:
      return joined([&](const BlockSink& sink) {
        simulate_envelope(scenario, device, {}, sink);
      });
    case Fidelity::kCarrier:
      return joined([&](const BlockSink& sink) {
        simulate_carrier(scenario, device, {}, sink);
      });
    case Fidelity::kQuasistatic:
      break;
  }
  return simulate_quasistatic(scenario, device);
}

int run(const RunArguments& arguments) {
  const bool csv = is_csv(arguments.output);
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.seed)
    overrides.push_back(fmt::format("seed={}", *arguments.seed));
  if (arguments.fidelity)
    overrides.push_back(fmt::format("fidelity=\"{}\"", *arguments.fidelity));
  LoadedScenario input = load_scenario(arguments.scenario, overrides);
  require_writable(arguments.output);
  require_consent(input.scenario, arguments.yes);

  const Progress progress("simulating " + arguments.scenario);
  Recording recording = simulate(input.scenario, input.device);
  recording.program_version = kProgramVersion;
  recording.git_revision = kGitRevision;
  recording.scenario_text = std::move(input.scenario_text);
  recording.device_text = std::move(input.device_text);
  recording.overrides_text = std::move(input.overrides_text);
  if (csv) {
    write_recording_csv(recording, arguments.output);
  } else {
    write_recording(recording, arguments.output);
  }
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
                   "KEY=VALUE, overrides a key of the scenario or its device; "
                   "may be repeated")
      ->allow_extra_args(false);
  command->add_option("--seed", arguments->seed, "overrides the seed");
  command->add_option(
      "--fidelity", arguments->fidelity,
      "overrides the fidelity: quasistatic, envelope or carrier");
  command->add_flag("--yes", arguments->yes,
                    "start a run that takes more than an hour");
  command->callback([arguments, &action] {
    action = [arguments] { return run(*arguments); };
  });
}

}  // namespace beamgyro
