// SPDX-License-Identifier: MIT
#include "validation/result/device_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "dataset/files/sha256.h"
#include "sim/scenario/run_warnings.h"
#include "sim/scenario/simulation_input.h"
#include "validation/external/file_compensator.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/judgement.h"
#include "validation/result/population_yield.h"

namespace beamgyro {
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

}  // namespace

struct DeviceValidator::State {
  ValidationRequest request;
  Qualification qualification;
  SpecificationFile specification;
  QualifiedDevice device;
  std::optional<Campaign> campaign;
  // The compensator, its training where it is known, or a model.
  std::unique_ptr<TestedCompensator> compensator;
  std::optional<Compensator> file;
  std::optional<ModelSpec> model;

  std::vector<InputFile> inputs;

  void add_file(const std::string& group, const std::filesystem::path& path) {
    inputs.push_back({group, path});
  }

  void open_compensator() {
    const std::string& argument = request.compensator;
    if (is_model(argument)) {
      model = read_model(argument);
      for (const auto& path : model->files) add_file("compensator", path);
      if (qualification.training.empty())
        throw std::invalid_argument(
            fmt::format("{}: has no [[training]], on which {} would be trained",
                        request.qualification.string(), argument));
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

  void require_baselines() const {
    if (!qualification.training.empty()) return;
    for (const Limit& limit : specification.limits)
      if (!limit.relative_to.empty() && limit.relative_to != "before")
        throw std::invalid_argument(fmt::format(
            "{}: the limit of {} is relative to the {}, which is trained on "
            "the [[training]] runs of {}; it has none",
            limit.place, limit.metric, limit.relative_to,
            request.qualification.string()));
  }

  ResultProvenance provenance() const {
    ResultProvenance p{
        .program_version = request.program_version,
        .git_revision = request.git_revision,
        .device = request.device.filename().string(),
        .qualification = request.qualification.filename().string(),
        .specification = specification.name,
        .false_accept_risk = specification.false_accept_risk,
        .files = {},
        .seeds = {}};
    for (const auto& [group, path] : inputs)
      p.files.push_back(
          {group, path.filename().string(), sha256_of_file(path)});
    for (const auto* runs : {&qualification.runs, &qualification.training,
                             &qualification.held_out})
      for (const QualificationRun& run : *runs)
        p.seeds.emplace_back(run.name, run.scenario.seed);
    return p;
  }
};

DeviceValidator::DeviceValidator(ValidationRequest request)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.request = std::move(request);
  const ValidationRequest& asked = s.request;
  LoadedDevice loaded = load_device(asked.device, {});
  s.device = {loaded.device, std::move(loaded.text)};
  s.qualification = read_qualification(asked.qualification);
  s.specification = asked_specification(asked);
  s.open_compensator();
  s.add_file("device", asked.device);
  for (const auto& path : s.qualification.files)
    s.add_file("qualification", path);
  if (asked.specification) s.add_file("specification", *asked.specification);
  if (asked.campaign) {
    s.campaign = Campaign::read(*asked.campaign, asked.devices);
    for (const SourceText& source : s.campaign->sources())
      s.add_file("campaign", source.path);
  }
  s.require_baselines();
}

DeviceValidator::~DeviceValidator() = default;
DeviceValidator::DeviceValidator(DeviceValidator&&) noexcept = default;

const ValidationRequest& DeviceValidator::request() const {
  return state_->request;
}

const std::vector<InputFile>& DeviceValidator::inputs() const {
  return state_->inputs;
}

DeviceValidation DeviceValidator::validate(
    std::size_t threads, const ProgressOfWork& progress) const {
  const State& s = *state_;
  const double share = s.campaign ? 0.05 : 0.8;  // of the work, of the device
  const TrainingData data = training_data(s.qualification, s.device, threads);
  std::unique_ptr<TestedCompensator> own;
  std::optional<Compensator> trained;
  if (s.model) {
    trained = trained_on(data, *s.model);
    own = tested(*trained);
  }
  const TestedCompensator& compensator = own ? *own : *s.compensator;
  const std::optional<Compensator>& known = s.model ? trained : s.file;

  DeviceValidation validation;
  DeviceEvidence& found = validation.evidence;
  found = device_evidence(s.qualification, s.device, compensator, data, threads,
                          known.has_value(), [&](double done) {
                            if (progress) progress(share * done);
                          });
  ValidationResult& result = validation.result;
  result.compensator = {
      tested_name(s.request.compensator), kind_of(s.request.compensator),
      known ? known->provenance.method : "", compensator.inputs()};
  result.metrics = metric_results(found, s.qualification, {}, threads);
  result.limits = decided_limits(s.specification, result.metrics);
  CheckedCompensator checked =
      checked_runs(found, s.qualification, compensator);
  if (known) checked.provenance = &known->provenance;
  result.checks = run_checks(checked, threads);
  const WordedVerdict verdict = verdict_of(result.limits, result.checks);
  result.verdict = verdict.verdict;
  result.words = verdict.words;
  result.warnings = warnings_about(s.qualification, s.device.device, found);
  result.provenance = s.provenance();
  if (s.campaign)
    result.population =
        population_yield({&*s.campaign, &s.qualification, &s.specification,
                          s.compensator.get(), s.model ? &*s.model : nullptr},
                         threads, [&](double done) {
                           if (progress) progress(share + (1 - share) * done);
                         });
  return validation;
}

}  // namespace beamgyro
