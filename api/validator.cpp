// SPDX-License-Identifier: MIT
#include "api/validator.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "api/validation_request.h"
#include "compensation/compensator/run_comparison.h"
#include "dataset/files/sha256.h"
#include "include/beamgyro/recording.h"
#include "parallel/work_queue.h"
#include "sim/scenario/run_warnings.h"
#include "validation/external/answer_checks.h"
#include "validation/metrics/rate_noise_model.h"
#include "validation/qualification/seed_draw.h"
#include "validation/result/metric_change.h"
#include "validation/result/population_yield.h"
#include "validation/result/recorded_evidence.h"
#include "validation/result/seed_verdicts.h"
#include "validation/result/set_verdicts.h"
#include "validation/result/undecidable_limits.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> warnings_about(const Qualification& qualification,
                                        const DeviceParameters& device,
                                        const DeviceEvidence& found) {
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < found.runs.size(); ++k) {
    RunWarnings texts(qualification.runs[k].scenario, device);
    texts.add(found.runs[k]);
    for (const std::string& text : texts.texts())
      warnings.push_back(
          fmt::format("{}: {}", qualification.runs[k].name, text));
  }
  return warnings;
}

// The samples of a run do not show what all of them have in common.
std::vector<std::string> warnings_about(const Evidence& evidence) {
  std::vector<std::string> unstated;
  for (const EvidenceRun& run : evidence.runs)
    if (!stated_noise(*run.recording)) unstated.push_back(run.name);
  if (unstated.empty()) return {};
  return {fmt::format(
      "{}{}: no device is stated, so the turn-on offset and the slow noise of "
      "the unit are unknown; the intervals leave them out and are too narrow "
      "by them",
      unstated.front(),
      unstated.size() == 1 ? ""
                           : fmt::format(" and {} more", unstated.size() - 1))};
}

// Why the sigma that a compensator states does not hold of runs.
std::vector<std::string> warnings_about(const FittedCompensator* compensator,
                                        const Evidence& evidence) {
  std::vector<std::string> warnings;
  if (compensator == nullptr || !compensator->sigma) return warnings;
  for (const EvidenceRun& run : evidence.runs)
    for (const std::string& reason :
         reasons_against_sigma(compensator->sigma->validity, *run.recording))
      warnings.push_back(fmt::format("{}: {}", run.name, reason));
  return warnings;
}

// A curve is that of one device.
std::vector<std::string> warnings_about_device(
    const FittedCompensator* compensator, const Evidence& evidence,
    const std::optional<RunSource>& set) {
  if (compensator == nullptr) return {};
  std::vector<std::string> others;
  for (const EvidenceRun& run : evidence.runs)
    if (set ? is_of_other_devices(compensator->provenance, set->set.value())
            : is_of_another_device(compensator->provenance, *run.recording))
      others.push_back(run.name);
  if (others.empty()) return {};
  return {fmt::format(
      "{}{}: of another device than the one that the compensator was trained "
      "on; a curve is that of one device",
      others.front(),
      others.size() == 1 ? ""
                         : fmt::format(" and {} more", others.size() - 1))};
}

// Said of code whose maker can know what it is judged on.
constexpr std::string_view kPublicSeed =
    " Judged with the public seed of the qualification, whose runs code can "
    "know beforehand: a random seed is the exam for code.";

}  // namespace

struct Validator::State : ValidationRequest {
  using ValidationRequest::ValidationRequest;

  std::optional<std::vector<std::string>> foreseen;

  // Over the runs of all devices of a set.
  std::optional<WorkbenchDifference> difference_from_workbench(
      const DeviceEvidence& evidence) const {
    if (!workbench) return std::nullopt;
    WorkbenchDifference all{.name = options.workbench->filename().string()};
    for (std::size_t k = 0; k < evidence.runs.size(); ++k)
      all.add(difference_of(
          evidence.answers[k],
          {.rate = compensated_rate(*workbench, evidence.runs[k])}));
    return all;
  }

  // Judges the compensator of --against on the same runs.
  SideBySide beside(const Qualification& judged, const ValidationResult& result,
                    DeviceEvidence& evidence, std::size_t threads) const {
    const auto other = tested(*against);
    const auto ready =
        ready_compensator(*other, specification.declared.ready_after);
    return side_by_side({.specification = specification,
                         .metric_runs = judged.metric_runs,
                         .compensator = *other,
                         .trained = &*against,
                         .own_metrics = own_metrics},
                        ready ? *ready : *other,
                        options.against->filename().string(), result, evidence,
                        threads);
  }

  // Of the files, then of those in memory.
  TrainingRun recording(std::size_t k, std::vector<std::string>* warned) const {
    if (k < options.recordings.size()) {
      const fs::path& path = options.recordings[k];
      return {.name = path.string(),
              .sha256 = sha256_of_file(path),
              .recording = beamgyro::read_recording(path, warned)};
    }
    const NamedRecording& run =
        options.recordings_in_memory[k - options.recordings.size()];
    return {.name = run.name,
            .sha256 = measured_sha256(run.recording),
            .recording = run.recording};
  }

  std::vector<std::string> warnings_about_isolation() const {
    if (!is_program(source.kind) || source.isolation->holds()) return {};
    return {fmt::format("{}: {}; it could read what it is judged by",
                        source.name, isolation_words(*source.isolation))};
  }

  FittedCompensator trained_model(const TrainingData& data) const try {
    return trained_on(data, *source.model);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format(
        "{} cannot be trained on the [[training]] runs of {}: {}",
        source.argument, options.qualification->string(), error.what()));
  }

  bool is_code() const {
    return is_program(source.kind) || source.kind == SourceKind::kFunction;
  }

  CompletedValidation validated(const Qualification& judged,
                                std::optional<std::uint64_t> seed,
                                std::size_t threads,
                                const ProgressOfWork& progress) const;

  // Draws the runs from a seed, if there is one.
  CompletedValidation validated_with(std::optional<std::uint64_t> seed,
                                     std::size_t threads,
                                     const ProgressOfWork& progress) const {
    return validated(
        seed ? drawn_qualification(qualification, *seed) : qualification, seed,
        threads, progress);
  }
};

Validator::Validator(CompensatorSource source, ValidationOptions options,
                     bool keeps_inputs)
    : state_(std::make_unique<State>(std::move(source), std::move(options),
                                     keeps_inputs)) {}

Validator::~Validator() = default;

const CompensatorSource& Validator::source() const { return state_->source; }
const ValidationOptions& Validator::options() const { return state_->options; }
const std::vector<ValidationInput>& Validator::inputs() const {
  return state_->inputs;
}

const std::vector<std::string>& Validator::foreseen() const {
  State& s = *state_;
  if (!s.foreseen)
    s.foreseen =
        s.options.device
            ? undecidable_limits(s.qualification, s.device, s.specification,
                                 thread_count(s.options.jobs))
            : std::vector<std::string>();
  return *s.foreseen;
}

CompletedValidation Validator::validate(std::size_t threads,
                                        const ProgressOfWork& progress) const {
  const State& s = *state_;
  foreseen();  // once, before the seeds need it side by side
  CompletedValidation done =
      s.options.seeds ? seed_verdicts(
                            {s.options.seed.value_or(1), *s.options.seeds},
                            [&s](std::uint64_t seed, std::size_t share) {
                              return s.validated_with(seed, share, {});
                            },
                            s.specification, threads, progress)
                      : s.validated_with(s.options.seed, threads, progress);
  if (s.options.device && !s.options.seed && s.is_code())
    done.result.words += kPublicSeed;
  return done;
}

CompletedValidation Validator::State::validated(
    const Qualification& judged, std::optional<std::uint64_t> seed,
    std::size_t threads, const ProgressOfWork& progress) const {
  const State& s = *this;
  const double share = s.campaign ? 0.05 : 0.8;  // of the work, of the device
  const ModelSpec* model = s.source.model ? &*s.source.model : nullptr;
  const TrainingData data =
      s.options.device ? training_data(judged, s.device, model, threads)
                       : TrainingData{};
  std::optional<FittedCompensator> trained = s.source.trained;
  std::shared_ptr<const TestedCompensator> compensator = s.source.tested;
  if (model != nullptr) {
    trained = s.trained_model(data);
    compensator = tested(*trained);
  }
  const FittedCompensator* known = trained ? &*trained : nullptr;

  CompletedValidation done;
  ValidationResult& result = done.result;
  std::optional<WorkbenchDifference> difference;
  const DeclaredResponse& declared = s.specification.declared;
  const auto ready = ready_compensator(*compensator, declared.ready_after);
  const TestedCompensator& answering_one = ready ? *ready : *compensator;
  const RecordedAnswering answering{answering_one, known, s.options.full_scale,
                                    s.options.require_provenance};
  if (s.options.device) {
    done.evidence =
        device_evidence(judged, s.device, answering_one, data, known != nullptr,
                        threads, [&](double part) {
                          if (progress) progress(share * part);
                        });
    result.warnings = s.foreseen.value();
    for (std::string& text :
         warnings_about(judged, s.device.device, done.evidence))
      result.warnings.push_back(std::move(text));
  } else if (s.set) {
    SetVerdicts found =
        set_verdicts(*s.set, answering, s.specification, threads, progress,
                     [&](const DeviceEvidence& one) {
                       const auto here = s.difference_from_workbench(one);
                       if (difference && here)
                         difference->add(*here);
                       else
                         difference = here;
                     });
    result = std::move(found.shown);
    result.population = std::move(found.devices);
    done.evidence = std::move(found.evidence);
  } else {
    done.evidence = recorded_evidence(
        s.options.recordings.size() + s.options.recordings_in_memory.size(),
        answering, threads,
        [&s](std::size_t k, std::vector<std::string>* warned) {
          return s.recording(k, warned);
        },
        result.warnings);
    s.require_same_recordings();
    for (std::string& text : warnings_about(done.evidence.before))
      result.warnings.push_back(std::move(text));
  }
  for (std::string& text : warnings_about(known, done.evidence.after))
    result.warnings.push_back(std::move(text));
  for (std::string& text :
       warnings_about_device(known, done.evidence.after, s.set))
    result.warnings.push_back(std::move(text));
  for (std::string& text : s.warnings_about_isolation())
    result.warnings.push_back(std::move(text));
  result.isolation = s.source.isolation;
  result.provenance = s.provenance(judged, seed);
  if (!s.set) {
    difference = s.difference_from_workbench(done.evidence);
    judge({s.specification, judged.metric_runs, *compensator, known, nullptr,
           s.options.require_provenance, s.own_metrics},
          done.evidence, threads, result);
  }
  result.compensator = {s.source.name, std::string(kind_name(s.source.kind)),
                        known != nullptr ? known->provenance.method : "",
                        compensator->inputs(), difference};
  if (s.against)
    result.against = s.beside(judged, result, done.evidence, threads);
  if (s.earlier) compare_with(*s.earlier, result);
  if (s.campaign)
    result.population = population_yield(
        {&*s.campaign, &judged, &s.specification, &answering_one, model, known},
        threads, [&](double part) {
          if (progress) progress(share + (1 - share) * part);
        });
  require_unchanged(s.source);
  if (model != nullptr) done.trained = std::move(trained);
  return done;
}

}  // namespace beamgyro::internal
