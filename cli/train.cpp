// SPDX-License-Identifier: MIT
#include "compensation/training/train.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/recorded_runs.h"
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/rows/set_runs.h"
#include "dataset/files/atomic_file.h"

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
  return {runs_of_files(arguments.runs), runs_of_files(arguments.held_out)};
}

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.6f}", *value) : "-";
}

void print_equation_one(const BiasModel& model, const char* label,
                        std::string& text) {
  const EquationOne equation = equation_one(model);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: F({:g} degC) = {:.6g} deg/s", label,
                 kReferenceTemperature, equation.bias_at_reference);
  for (std::size_t i = 0; i < equation.coefficients.size(); ++i) {
    fmt::format_to(out, ", a{} = {:.6g} K^-{}", i + 1, equation.coefficients[i],
                   i + 1);
  }
  text += '\n';
}

void print_restarts(const TrainResult& result, std::string& text) {
  auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < result.restarts.size(); ++k) {
    const TrainSummary& summary = result.restarts[k];
    fmt::format_to(out,
                   "restart {}{}: {} epochs, best {}, rms in-sample {:.6f}, "
                   "held-out {} deg/s; {}\n",
                   k + 1, k == result.chosen ? " (kept)" : "", summary.epochs,
                   summary.best_epoch, summary.in_sample_rms,
                   shown(summary.held_out_rms), sentence(summary.stop_reason));
  }
}

// One line for each group.
void print_groups(const CrossValidated& cv, std::string& text) {
  for (std::size_t k = 0; k < cv.group_rms.size(); ++k)
    fmt::format_to(std::back_inserter(text),
                   "{} {}: rms {:.6f} deg/s unseen, of a constant {:.6f}\n",
                   cv.by, k + 1, cv.group_rms[k], cv.constant_group_rms[k]);
}

std::string report(const TrainResult& result, bool every_group) {
  const Provenance& source = result.compensator.provenance;
  std::string text =
      fmt::format("{}, {} rows, {} held-out rows\n", source.method, result.rows,
                  result.held_out_rows);
  auto out = std::back_inserter(text);
  for (const std::string& choice : source.choices)
    fmt::format_to(out, "choice: {}\n", choice);
  if (std::holds_alternative<BpNetwork>(result.compensator.bias.function))
    print_restarts(result, text);
  fmt::format_to(out, "stopped: {}\n", source.stop_reason);
  fmt::format_to(out, "rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.in_sample_rms, shown(source.held_out_rms));
  if (const auto& cv = source.cross_validated) {
    if (every_group) print_groups(*cv, text);
    fmt::format_to(out,
                   "rms cross-validated over {} {}s {:.6f} +- {:.6f} deg/s, of "
                   "a constant {:.6f} deg/s\n",
                   cv->groups, cv->by, cv->rms, cv->standard_error,
                   cv->constant_rms);
  }
  fmt::format_to(out, "cubic: rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.baseline_in_sample_rms,
                 shown(source.baseline_held_out_rms));
  fmt::format_to(out, "constant: rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.constant_in_sample_rms,
                 shown(source.constant_held_out_rms));
  print_equation_one(result.compensator.baseline, "cubic", text);
  return text;
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
  const Sources sources = sources_of(arguments);
  std::optional<Progress> progress("training " + arguments.output);
  const TrainResult result = train(spec, sources.training, sources.held_out,
                                   static_cast<std::uint64_t>(arguments.seed),
                                   grouping(arguments.cross_validation));
  write_compensator(result.compensator, arguments.output);
  progress.reset();
  for (const std::string& warning : result.compensator.provenance.warnings)
    print_warning(warning);
  print_result(report(result, !arguments.cross_validation.empty()));
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
