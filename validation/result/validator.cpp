// SPDX-License-Identifier: MIT
#include "validation/result/validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "config/option_message.h"
#include "dataset/files/sha256.h"
#include "dataset/set/manifest.h"
#include "sim/scenario/run_warnings.h"
#include "sim/scenario/simulation_input.h"
#include "validation/external/answer_checks.h"
#include "validation/external/file_compensator.h"
#include "validation/metrics/rate_noise_model.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/judgement.h"
#include "validation/result/population_yield.h"
#include "validation/result/recorded_evidence.h"
#include "validation/result/set_verdicts.h"

namespace beamgyro::internal {
namespace {

// Without a specification: some drift must be removed. The checks ask the rest.
constexpr const char* kOwnSpecification = R"(
name = "without a specification"
[limits_relative_to.before]
residual_rms_deg_per_s = { max = 1.0, source = "less than without it" }
)";

SpecificationFile asked_specification(const ValidationRequest& request) {
  if (request.specification)
    return read_specification_file(*request.specification);
  return parse_specification_file(kOwnSpecification, "specification");
}

bool is_model(const std::string& argument) {
  return argument.ends_with(".toml");
}

bool is_file(const std::string& argument) {
  return argument.ends_with(".json");
}

std::string kind_of(const std::string& argument) {
  if (is_model(argument)) return "model";
  if (is_file(argument)) return "compensator";
  return argument.starts_with("cmd:") ? "command" : "library";
}

std::vector<std::string> warnings_about(const Qualification& qualification,
                                        const Device& device,
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

}  // namespace

struct Validator::State {
  ValidationRequest request;
  Qualification qualification;
  SpecificationFile specification;
  QualifiedDevice device;
  std::optional<Campaign> campaign;
  // The compensator, its training where it is known, or a model.
  std::shared_ptr<const TestedCompensator> compensator;
  std::optional<Compensator> file;
  std::optional<ModelSpec> model;
  std::optional<Compensator> workbench;
  std::optional<RunSource> set;

  std::vector<InputFile> inputs;

  void add_file(const std::string& group, const std::filesystem::path& path,
                std::optional<std::string> text = {}) {
    inputs.push_back({group, path, std::move(text)});
  }

  void read_device() {
    const std::optional<GivenDevice>& given = request.given_device;
    LoadedDevice loaded =
        given ? load_device(InputText{given->text, request.device->string()},
                            given->overrides)
              : load_device(*request.device, {});
    device = {loaded.device, std::move(loaded.text)};
    qualification = read_qualification(request.qualification);
    add_file("device", *request.device,
             given ? std::optional(given->text) : std::nullopt);
    for (const auto& path : qualification.files)
      add_file("qualification", path);
  }

  // The manifest tells every file of a set.
  void open_set() {
    if (!request.set) return;
    set = runs_of_set(*request.set, request.selection);
    add_file("runs", *request.set / kManifestName);
  }

  void open_workbench() {
    if (!request.workbench) return;
    workbench = read_compensator(*request.workbench);
    add_file("workbench", *request.workbench);
  }

  std::optional<WorkbenchDifference> difference_from_workbench(
      const DeviceEvidence& evidence) const {
    if (!workbench) return std::nullopt;
    WorkbenchDifference all{.name = request.workbench->filename().string()};
    double squares = 0.0;
    for (std::size_t k = 0; k < evidence.runs.size(); ++k) {
      const AnswerDifference one = difference_of(
          evidence.answers[k],
          {.rate = compensated_rate(*workbench, evidence.runs[k])});
      const auto samples = static_cast<double>(one.samples);
      all.largest = std::max(all.largest, one.largest);
      all.samples += one.samples;
      squares += samples * one.rms * one.rms;
    }
    if (all.samples > 0)
      all.rms = std::sqrt(squares / static_cast<double>(all.samples));
    return all;
  }

  void require_device_of_model() const {
    if (request.device) return;
    throw option_error(
        "{}: a model is trained on simulated runs; expected {}, or a "
        "compensator that was trained",
        request.compensator, NamedOption{"device", "DEVICE.toml"});
  }

  void require_training_runs() const {
    if (!qualification.training.empty()) return;
    throw std::invalid_argument(
        fmt::format("{}: has no [[training]], on which {} would be trained",
                    request.qualification.string(), request.compensator));
  }

  void take_compensator(const GivenCompensator& given) {
    compensator = given.tested;
    file = given.trained;
    model = given.model;
    if (file) compensator = tested(*file);
    if (model) {
      require_device_of_model();
      require_training_runs();
    }
    if (given.text) add_file("compensator", request.compensator, given.text);
  }

  void open_compensator() {
    const std::string& argument = request.compensator;
    if (request.given) return take_compensator(*request.given);
    if (is_model(argument)) {
      require_device_of_model();
      model = read_model(argument);
      for (const auto& path : model->files) add_file("compensator", path);
      require_training_runs();
      return;
    }
    if (is_file(argument)) {
      file = read_compensator(argument);
      compensator = tested(*file);
    } else {
      compensator = open_tested_compensator(argument, request.limits);
    }
    if (!argument.starts_with("cmd:")) add_file("compensator", argument);
  }

  Compensator trained_model(const TrainingData& data) const try {
    return trained_on(data, *model);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format(
        "{} cannot be trained on the [[training]] runs of {}: {}",
        request.compensator, request.qualification.string(), error.what()));
  }

  // Throws when a limit is relative to a baseline that there will not be.
  void require_baselines() const {
    if (!qualification.training.empty()) return;
    for (const Limit& limit : specification.limits) {
      if (limit.relative_to.empty() || limit.relative_to == "before") continue;
      if (!request.device && file && limit.relative_to == "cubic") continue;
      throw std::invalid_argument(fmt::format(
          "{}: the limit of {} is relative to the {}, which is trained on the "
          "[[training]] runs of a qualification; there are none",
          limit.place, limit.metric, limit.relative_to));
    }
  }

  ResultProvenance provenance() const {
    ResultProvenance p{
        .program_version = request.program_version,
        .git_revision = request.git_revision,
        .device = request.device ? request.device->filename().string() : "",
        .qualification = request.qualification.filename().string(),
        .specification = specification.name,
        .false_accept_risk = specification.false_accept_risk,
        .files = {},
        .seeds = {}};
    for (const auto& [group, path, text] : inputs)
      p.files.push_back({group, path.filename().string(),
                         text ? sha256(*text) : sha256_of_file(path)});
    for (const auto* runs : {&qualification.runs, &qualification.training,
                             &qualification.held_out, &qualification.turning})
      for (const QualificationRun& run : *runs)
        p.seeds.emplace_back(run.name, run.scenario.seed);
    return p;
  }
};

Validator::Validator(ValidationRequest request)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.request = std::move(request);
  const ValidationRequest& asked = s.request;
  if (asked.device) s.read_device();
  s.specification = asked_specification(asked);
  s.open_compensator();
  s.open_workbench();
  s.open_set();
  for (const auto& path : asked.runs) s.add_file("runs", path);
  if (asked.specification) s.add_file("specification", *asked.specification);
  if (asked.campaign) {
    s.campaign = Campaign::read(*asked.campaign, asked.devices);
    for (const SourceText& source : s.campaign->sources())
      s.add_file("campaign", source.path);
  }
  s.require_baselines();
}

Validator::~Validator() = default;
Validator::Validator(Validator&&) noexcept = default;

const ValidationRequest& Validator::request() const { return state_->request; }

const std::vector<InputFile>& Validator::inputs() const {
  return state_->inputs;
}

CompletedValidation Validator::validate(std::size_t threads,
                                        const ProgressOfWork& progress) const {
  const State& s = *state_;
  const double share = s.campaign ? 0.05 : 0.8;  // of the work, of the device
  const TrainingData data =
      s.request.device ? training_data(s.qualification, s.device,
                                       s.model ? &*s.model : nullptr, threads)
                       : TrainingData{};
  std::unique_ptr<TestedCompensator> own;
  std::optional<Compensator> trained;
  if (s.model) {
    trained = s.trained_model(data);
    own = tested(*trained);
  }
  const TestedCompensator& compensator = own ? *own : *s.compensator;
  const Compensator* known = s.model ? &*trained : s.file ? &*s.file : nullptr;

  CompletedValidation done;
  ValidationResult& result = done.result;
  if (s.request.device) {
    done.evidence =
        device_evidence(s.qualification, s.device, compensator, data,
                        known != nullptr, threads, [&](double part) {
                          if (progress) progress(share * part);
                        });
    result.warnings =
        warnings_about(s.qualification, s.device.device, done.evidence);
  } else if (s.set) {
    SetVerdicts found =
        set_verdicts(*s.set, {compensator, known, s.request.full_scale},
                     s.specification, threads, progress);
    result = std::move(found.shown);
    result.population = std::move(found.devices);
    done.evidence = std::move(found.evidence);
  } else {
    done.evidence = recorded_evidence(
        s.request.runs, {compensator, known, s.request.full_scale}, threads);
    result.warnings = warnings_about(done.evidence.before);
  }
  result.provenance = s.provenance();
  result.compensator = {
      tested_name(s.request.compensator),
      s.request.given ? s.request.given->kind : kind_of(s.request.compensator),
      known != nullptr ? known->provenance.method : "", compensator.inputs(),
      s.difference_from_workbench(done.evidence)};
  if (!s.set)
    judge({s.specification, s.qualification.metric_runs, compensator,
           known != nullptr ? &known->provenance : nullptr},
          done.evidence, threads, result);
  if (s.campaign)
    result.population =
        population_yield({&*s.campaign, &s.qualification, &s.specification,
                          s.compensator.get(), s.model ? &*s.model : nullptr},
                         threads, [&](double part) {
                           if (progress) progress(share + (1 - share) * part);
                         });
  return done;
}

}  // namespace beamgyro::internal
