// SPDX-License-Identifier: MIT
#include "compensation/training/train.h"

#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/rows/recorded_runs.h"
#include "compensation/rows/set_runs.h"
#include "dataset/files/atomic_file.h"
#include "report/training_report.h"

namespace beamgyro {
namespace {

struct TrainArguments {
  std::vector<std::string> runs, held_out;
  std::vector<std::string> set_runs;       // names, of a set
  std::vector<std::uint32_t> set_devices;  // of a set
  std::string model, output, cross_validation;
  std::int64_t seed = 0;
};

struct Sources {
  RunSource training, held_out;
};

// Of a set the training devices, its validation devices held out; or some
// devices alone.
Sources sources_of_set(const TrainArguments& arguments) {
  if (!arguments.held_out.empty() || !arguments.cross_validation.empty())
    throw std::invalid_argument(
        "--held-out and --cv: of a set the validation devices are held out");
  const auto of_part = [&](SetPartNumber part) {
    return runs_of_set(arguments.runs[0], {part, arguments.set_runs});
  };
  if (arguments.set_devices.empty())
    return {of_part(SetPartNumber::kTrain),
            of_part(SetPartNumber::kValidation)};
  return {runs_of_set(arguments.runs[0],
                      {{}, arguments.set_runs, arguments.set_devices}),
          {}};
}

Sources sources_of(const TrainArguments& arguments) {
  if (is_set(arguments.runs)) return sources_of_set(arguments);
  if (!arguments.set_runs.empty() || !arguments.set_devices.empty())
    throw std::invalid_argument(
        "--run and --device choose from a set, and there is none");
  return {runs_of_files(arguments.runs, load_recording),
          runs_of_files(arguments.held_out, load_recording)};
}

std::optional<Grouping> grouping(const std::string& name) {
  if (name == "run") return Grouping::kRun;
  if (name == "cycle") return Grouping::kCycle;
  if (name == "leg") return Grouping::kLeg;
  return std::nullopt;
}

int run_training(const TrainArguments& arguments) {
  const ModelSpec spec = read_model(arguments.model);
  std::vector<std::filesystem::path> inputs = spec.files;
  inputs.insert(inputs.end(), arguments.runs.begin(), arguments.runs.end());
  inputs.insert(inputs.end(), arguments.held_out.begin(),
                arguments.held_out.end());
  require_output(arguments.output, inputs);
  require_ending(arguments.output, {".json"});
  const Sources sources = sources_of(arguments);
  std::optional<Progress> progress("training " + arguments.output);
  const TrainResult result = train(spec, sources.training, sources.held_out,
                                   static_cast<std::uint64_t>(arguments.seed),
                                   grouping(arguments.cross_validation));
  write_compensator(result.compensator, arguments.output);
  progress.reset();
  for (const std::string& warning : result.compensator.provenance.warnings)
    print_warning(warning);
  print_result(training_report(result, !arguments.cross_validation.empty()));
  return 0;
}

}  // namespace

void add_train(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<TrainArguments>();
  CLI::App* command = program.add_subcommand(
      "train",
      "Fit a compensator to recordings of one gyro, or to a set of gyros");
  command
      ->add_option("runs", arguments->runs,
                   "RUN.h5..., or the directory of a set")
      ->required();
  command->add_option("--model", arguments->model, "MODEL.toml")->required();
  command->add_option(
      "--held-out", arguments->held_out,
      "RUN.h5... are scored but not fitted; a network stops early on them");
  command
      ->add_option("--cv", arguments->cross_validation,
                   "Cross-validates: holds out each recording (run), each "
                   "power cycle (cycle) or each leg between reversals of the "
                   "temperature (leg) in turn")
      ->check(CLI::IsMember({"run", "cycle", "leg"}));
  command->add_option("--run", arguments->set_runs,
                      "NAME of a run of the set; the default is all of them");
  command->add_option("--device", arguments->set_devices,
                      "NUMBER of the device of a set to fit, in place of the "
                      "training devices; may be repeated");
  command->add_option("-o,--output", arguments->output, "COMPENSATOR.json")
      ->required();
  command->add_option("--seed", arguments->seed, "Seed of the initial weights")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->callback([arguments, &action] {
    action = [arguments] { return run_training(*arguments); };
  });
}

}  // namespace beamgyro
