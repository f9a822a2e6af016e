// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "include/beamgyro/simulate.h"

namespace beamgyro::internal {
namespace {

struct RunArguments {
  std::string scenario, output, fidelity;
  std::vector<std::string> overrides;
  std::optional<long> seed;
  bool yes = false;
  bool stop_on_unlock = false;
};

// A run that will take longer needs --yes [s].
constexpr double kLongRun = 3600;

void require_consent(const Scenario& scenario, bool yes) {
  const double cost = scenario.estimated_seconds();
  if (cost <= kLongRun || yes) return;
  throw std::invalid_argument(fmt::format(
      "a carrier run of {:g} s would take about {:.1f} h here; pass --yes to "
      "start it, or use the envelope fidelity",
      scenario.duration(), cost / 3600));
}

int run(const RunArguments& arguments) {
  require_recording_name(arguments.output);
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.seed)
    overrides.push_back(fmt::format("seed={}", *arguments.seed));
  if (!arguments.fidelity.empty())
    overrides.push_back(fmt::format("fidelity=\"{}\"", arguments.fidelity));
  const auto scenario = Scenario::read(arguments.scenario, overrides);
  require_output(arguments.output, scenario.files());
  require_consent(scenario, arguments.yes);

  Progress progress("simulating " + arguments.scenario);
  const std::vector<std::string> warnings =
      simulate_to_file(scenario, arguments.output,
                       {.stop_on_unlock = arguments.stop_on_unlock,
                        .progress = progress.shown_share()});
  for (const std::string& warning : warnings)
    keep_warning(fmt::format("{}: {}", arguments.scenario, warning));
  return 0;
}

}  // namespace

void add_run(CommandLine& program) {
  const auto [command, arguments] = program.add<RunArguments>(
      "run", kSimulation,
      "Simulates one gyro in one scenario and writes a recording", run);
  command.text({"SCENARIO.toml", "", "Scenario file, which names its device"},
               arguments.scenario);
  command.reads({{FileKind::kScenario}});
  command.text({"-o,--output", "RUN.h5", "Recording to write, .h5 or .csv"},
               arguments.output);
  command.flag({"--yes", "",
                "Starts a carrier run even if it will take more than an hour"},
               arguments.yes);
  command.flag({"--stop-on-unlock", "",
                "Fails where the drive loop is not locked one second after a "
                "power-on or later"},
               arguments.stop_on_unlock);
  command.group("Changes of the scenario");
  command.texts({"--set", "KEY=VALUE",
                 "Replaces a key of the scenario or of its device; may be "
                 "repeated",
                 "the files as they are"},
                arguments.overrides);
  command.integer(
      {"--seed", "N", "Seed of everything random", "that of the scenario"},
      arguments.seed);
  command.choice(
      {"--fidelity", "quasistatic|envelope|carrier",
       "How much of the physics is simulated", "that of the scenario"},
      arguments.fidelity, {"quasistatic", "envelope", "carrier"});
  command.example("beamgyro run scenarios/warm_up.toml -o warm_up.h5",
                  "The first hour after power-on");
  command.example(
      "beamgyro run scenarios/rest.toml -o rest.h5 --seed 2 "
      "--set beam.length_m=0.041",
      "A longer beam and other noise");
}

}  // namespace beamgyro::internal
