// SPDX-License-Identifier: MIT
#include "include/beamgyro/train.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "api/compensators.h"
#include "api/shared_maker.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/compensator/run_comparison.h"
#include "compensation/rows/run_source.h"
#include "compensation/training/model_file.h"
#include "compensation/training/train.h"
#include "include/beamgyro/progress.h"
#include "report/training_report.h"

namespace beamgyro {
namespace {

/// Warnings about files, each once, however often a file is read.
class FileWarnings {
 public:
  Recording read(const std::filesystem::path& path) {
    std::vector<std::string> found;
    Recording recording = read_recording(path, &found);
    for (std::string& warning : found)
      if (std::ranges::count(texts_, warning) == 0)
        texts_.push_back(std::move(warning));
    return recording;
  }

  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

std::optional<internal::Grouping> grouping_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (name == "run") return internal::Grouping::kRun;
  if (name == "cycle") return internal::Grouping::kCycle;
  if (name == "leg") return internal::Grouping::kLeg;
  throw std::invalid_argument(fmt::format(
      "cross-validation by \"{}\"; expected run, cycle or leg", name));
}

// Makes the networks of a model tell of their epochs, one at a time.
void observe_epochs(internal::ModelSpec& spec, const TrainingOptions& options) {
  if (!options.progress) return;
  auto one_at_a_time = std::make_shared<std::mutex>();
  internal::observe(spec, [one_at_a_time, on_epoch = options.progress](
                              const TrainingProgress& report) {
    const std::lock_guard lock(*one_at_a_time);
    if (!on_epoch(report)) throw Cancelled();
  });
}

// A compensator that no command reads is not handed out.
void require_that_it_reads(const internal::CompensatorState& state) {
  try {
    internal::parse_compensator(state.text, state.name);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(
        fmt::format("training gave a compensator that cannot be read back: {}",
                    error.what()));
  }
}

TrainedCompensator trained(const Model& model,
                           const internal::RunSource& training,
                           const internal::RunSource& held_out,
                           const TrainingOptions& options) {
  internal::ModelSpec spec = model.content();
  observe_epochs(spec, options);
  internal::TrainResult result =
      internal::train(spec, training, held_out, options.seed,
                      grouping_of(options.cross_validation));
  std::string report =
      internal::training_report(result, !options.cross_validation.empty());
  auto state = std::make_shared<internal::CompensatorState>();
  state->compensator = std::move(result.compensator);
  state->text = internal::compensator_text(state->compensator);
  state->name = "compensator.json";
  require_that_it_reads(*state);
  std::vector<std::string> warnings = state->compensator.provenance.warnings;
  return {internal::SharedMaker::make<Compensator>(std::move(state)),
          std::move(warnings), std::move(report)};
}

std::vector<std::string> names_of(
    const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  for (const std::filesystem::path& path : paths)
    names.push_back(path.string());
  return names;
}

internal::RunSource source_of_recordings(
    const std::vector<NamedRecording>& recordings) {
  return {.count = recordings.size(),
          .for_each = [&recordings](const internal::RunSource::Visitor& visit) {
            // Of what was measured: there is no file.
            for (const NamedRecording& one : recordings)
              visit({one.name, internal::measured_sha256(one.recording),
                     one.recording});
          }};
}

}  // namespace

Model Model::read(const std::filesystem::path& file) {
  return internal::SharedMaker::make<Model>(
      std::make_shared<const internal::ModelSpec>(internal::read_model(file)));
}

Model Model::parse(const std::string& text, const std::string& name) {
  return internal::SharedMaker::make<Model>(
      std::make_shared<const internal::ModelSpec>(
          internal::read_model(internal::ConfigDocument::parse(text, name))));
}

std::string Model::text() const { return content().text; }
std::string Model::name() const { return content().files.front().string(); }
std::vector<std::filesystem::path> Model::files() const {
  return content().files;
}

TrainedCompensator train(const Model& model,
                         const std::vector<std::filesystem::path>& files,
                         const std::vector<std::filesystem::path>& held_out,
                         const TrainingOptions& options) {
  const std::vector<std::string> fitted = names_of(files);
  const std::vector<std::string> kept = names_of(held_out);
  internal::require_different_runs(fitted);
  internal::require_different_runs(kept);
  FileWarnings of_files;
  const auto read = [&](const std::filesystem::path& path) {
    return of_files.read(path);
  };
  TrainedCompensator result =
      trained(model, internal::runs_of_files(fitted, read),
              internal::runs_of_files(kept, read), options);
  result.warnings.insert(result.warnings.end(), of_files.texts().begin(),
                         of_files.texts().end());
  return result;
}

TrainedCompensator train(const Model& model,
                         const std::vector<NamedRecording>& recordings,
                         const std::vector<NamedRecording>& held_out,
                         const TrainingOptions& options) {
  for (const auto* runs : {&recordings, &held_out})
    for (const NamedRecording& run : *runs)
      internal::require_sound(run.recording, run.name);
  return trained(model, source_of_recordings(recordings),
                 source_of_recordings(held_out), options);
}

TrainedCompensator train(const Model& model, const Set& set,
                         const SetChoice& choice,
                         const TrainingOptions& options) {
  if (!options.cross_validation.empty() && choice.devices.size() != 1)
    throw std::invalid_argument(
        "cross-validation: of a set the validation devices are held out; one "
        "device can be cross-validated");
  const auto part = [&](internal::SetPartNumber number) {
    return internal::runs_of_set(set.directory(), {number, choice.runs});
  };
  if (choice.devices.empty())
    return trained(model, part(internal::SetPartNumber::kTrain),
                   part(internal::SetPartNumber::kValidation), options);
  return trained(
      model,
      internal::runs_of_set(set.directory(), {{}, choice.runs, choice.devices}),
      {}, options);
}

}  // namespace beamgyro
