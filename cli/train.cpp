// SPDX-License-Identifier: MIT
#include "include/beamgyro/train.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

struct TrainArguments {
  std::vector<std::filesystem::path> runs, held_out;
  SetChoice choice;  // of a set
  std::string model, output;
  TrainingOptions options;
};

/// The last epoch that a network told of, from whatever thread.
class LastEpoch {
 public:
  void note(const TrainingProgress& report) {
    const std::lock_guard lock(mutex_);
    last_ = report;
  }

  std::string text() const {
    const std::lock_guard lock(mutex_);
    if (last_.epoch == 0) return "";
    return fmt::format("restart {}/{}, epoch {}/{}, rms {:.3g} deg/s",
                       last_.restart, last_.restarts, last_.epoch,
                       last_.max_epochs, last_.rms);
  }

 private:
  mutable std::mutex mutex_;
  TrainingProgress last_;
};

TrainedCompensator trained(const TrainArguments& arguments,
                           const Model& model) {
  const auto& [runs, held_out, choice, name, output, options] = arguments;
  if (!is_set(runs)) {
    if (!choice.runs.empty() || !choice.devices.empty())
      throw std::invalid_argument(
          "--run and --device choose from a set, and there is none");
    return train(model, runs, held_out, options);
  }
  const bool is_one_device = choice.devices.size() == 1;
  if (!held_out.empty() ||
      (!options.cross_validation.empty() && !is_one_device))
    throw std::invalid_argument(
        "--held-out and --cv: of a set the validation devices are held out; "
        "--cv takes one device, --device K");
  return train(model, Set::open(runs[0]), choice, options);
}

int run_training(TrainArguments& arguments) {
  const Model model = Model::read(arguments.model);
  std::vector<std::filesystem::path> inputs = model.files();
  inputs.insert(inputs.end(), arguments.runs.begin(), arguments.runs.end());
  inputs.insert(inputs.end(), arguments.held_out.begin(),
                arguments.held_out.end());
  require_output(arguments.output, inputs);
  require_ending(arguments.output, {".json"});
  LastEpoch epoch;
  arguments.options.progress = [&](const TrainingProgress& report) {
    epoch.note(report);
    return true;
  };
  std::optional<Progress> progress(
      std::in_place, "training " + arguments.output,
      [&] { return Progress::Status{.share = 0, .detail = epoch.text()}; });
  const TrainedCompensator result = trained(arguments, model);
  result.compensator.write(arguments.output);
  progress.reset();
  for (const std::string& warning : result.warnings) print_warning(warning);
  print_result(result.text);
  return 0;
}

}  // namespace

void add_train(CommandLine& program) {
  const auto [command, arguments] = program.add<TrainArguments>(
      "train", kCompensation,
      "Fits a compensator to recordings of one gyro, or to a set of gyros",
      run_training);
  command.list({"RUN.h5...", "",
                "Recordings to fit, or the directory of a set, whose "
                "training devices are fitted"},
               arguments.runs);
  command.reads({{FileKind::kRecording, FileKind::kSet}});
  command.text({"--model", "MODEL.toml", "Kind of compensator and its options"},
               arguments.model);
  command.reads({{FileKind::kModel}});
  command.text({"-o,--output", "COMPENSATOR.json", "Compensator to write"},
               arguments.output);
  command.integer({"--seed", "N", "Seed of the initial weights", "0"},
                  arguments.options.seed);
  command.group("Recordings that are not fitted");
  command.list(
      {"--held-out", "RUN.h5...",
       "Recordings that are scored; a network stops early on them", "none"},
      arguments.held_out);
  command.reads({{FileKind::kRecording}});
  command.choice({"--cv", "run|cycle|leg",
                  "Cross-validates: holds out each recording, each power cycle "
                  "or each leg between reversals of the temperature in turn",
                  "no cross-validation"},
                 arguments.options.cross_validation, {"run", "cycle", "leg"});
  command.group("Part of a set");
  command.list({"--run", "NAME", "Run to take; may be repeated", "all runs"},
               arguments.choice.runs);
  command.integers({"--device", "NUMBER",
                    "Device to fit; may be repeated. Holds nothing out; one "
                    "may be cross-validated",
                    "the training devices"},
                   arguments.choice.devices, {0, kLastDevice});
  command.example(
      "beamgyro train ramp.h5 --model scenarios/models/cubic.toml -o "
      "cubic.json",
      "A cubic of the temperature");
  command.example(
      "beamgyro train ramp.h5 --model scenarios/models/bp.toml --held-out "
      "soak.h5 -o bp.json",
      "A network that stops early on another recording");
}

}  // namespace beamgyro::internal
