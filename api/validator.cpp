// SPDX-License-Identifier: MIT
#include "api/validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "api/program_version.h"
#include "api/scenario_state.h"
#include "api/validation_members.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/rows/set_runs.h"
#include "config/option_message.h"
#include "dataset/files/file_state.h"
#include "dataset/files/json_node.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/set/manifest.h"
#include "include/beamgyro/recording.h"
#include "sim/scenario/run_warnings.h"
#include "validation/external/answer_checks.h"
#include "validation/external/compensator_source.h"
#include "validation/metrics/rate_noise_model.h"
#include "validation/qualification/qualification_file.h"
#include "validation/result/judgement.h"
#include "validation/result/population_yield.h"
#include "validation/result/recorded_evidence.h"
#include "validation/result/set_verdicts.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMostDevices = 4'000'000'000;

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

}  // namespace

struct Validator::State {
  CompensatorSource source;
  ValidationOptions options;
  Qualification qualification;
  SpecificationFile specification;
  QualifiedDevice device;
  std::optional<CampaignPlan> campaign;
  std::optional<FittedCompensator> workbench;
  std::optional<RunSource> set;
  std::vector<ValidationInput> inputs;
  std::vector<FileState> recording_states;  // before they were read

  void add_file(const std::string& group, const fs::path& path,
                std::string text) {
    std::string digits = sha256(text);
    inputs.push_back({group, path, std::move(digits), std::move(text)});
  }

  void read_device() {
    device = {options.device->content().device, options.device->text()};
    const std::vector<std::string> overrides = options.device->overrides();
    for (const std::string& line : overrides) device.overrides += line + '\n';
    qualification = read_qualification(*options.qualification);
    add_file("device", options.device->name(), options.device->text());
    for (const SourceText& file : qualification.files)
      add_file("qualification", file.path, file.text);
  }

  void read_specification() {
    specification = options.specification
                        ? read_specification_file(*options.specification)
                        : default_specification();
    if (options.specification)
      add_file("specification", *options.specification, specification.text);
  }

  void open_set() {
    SetSelection selection{{}, options.runs, options.devices};
    if (options.devices.empty()) selection.part = SetPartNumber::kTest;
    set = runs_of_set(options.set->directory(), selection);
    // The manifest tells every file of a set.
    const fs::path manifest = options.set->directory() / kManifestName;
    add_file("runs", manifest, read_text_file(manifest));
  }

  void hash_recordings(bool keeps_inputs) {
    for (const fs::path& path : options.recordings) {
      recording_states.push_back(state_of_file(path));
      if (keeps_inputs)
        add_file("runs", path, read_text_file(path));
      else
        inputs.push_back({"runs", path, sha256_of_file(path), ""});
    }
  }

  void read_workbench() {
    const std::string text = read_text_file(*options.workbench);
    workbench = parse_compensator(text, options.workbench->string());
    add_file("workbench", *options.workbench, text);
  }

  void read_campaign() {
    campaign = CampaignPlan::read(
        *options.campaign, options.campaign_devices
                               ? std::optional<long>(*options.campaign_devices)
                               : std::nullopt);
    for (const SourceText& file : campaign->sources)
      add_file("campaign", file.path, file.text);
  }

  // Recordings are read after they were hashed. One that was replaced and
  // replaced back is another file, or was moved or written later.
  void require_same_recordings() const {
    for (std::size_t k = 0; k < options.recordings.size(); ++k) {
      const fs::path& path = options.recordings[k];
      if (state_of_file(path) != recording_states[k])
        throw std::runtime_error(path.string() + ": changed while it was read");
    }
  }

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

  // Code of others must not read what it is judged by.
  void isolate_code() {
    std::vector<fs::path> hidden;
    for (const ValidationInput& input : inputs)
      if (input.group != "compensator") hidden.push_back(input.path);
    if (options.set) hidden.push_back(options.set->directory());
    isolate_code_of(source, {.plugin_files = options.plugin_files,
                             .hidden = std::move(hidden),
                             .required = options.require_isolation});
  }

  std::vector<std::string> warnings_about_isolation() const {
    if (!is_program(source.kind) || source.isolation->holds()) return {};
    return {fmt::format("{}: {}; it could read what it is judged by",
                        source.name, isolation_words(*source.isolation))};
  }

  void require_model_can_be_trained() const {
    if (!source.model) return;
    if (!options.device)
      throw option_error(
          "{}: a model is trained on simulated runs; expected {}, or a "
          "compensator that was trained",
          source.argument, NamedOption{"device", "DEVICE.toml"});
    if (qualification.training.empty())
      throw std::invalid_argument(
          fmt::format("{}: has no [[training]], on which {} would be trained",
                      options.qualification->string(), source.argument));
  }

  FittedCompensator trained_model(const TrainingData& data) const try {
    return trained_on(data, *source.model);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format(
        "{} cannot be trained on the [[training]] runs of {}: {}",
        source.argument, options.qualification->string(), error.what()));
  }

  // Throws when a limit is relative to a baseline that there will not be.
  void require_baselines() const {
    if (!qualification.training.empty()) return;
    for (const Limit& limit : specification.limits) {
      if (limit.relative_to.empty() || limit.relative_to == "before") continue;
      if (!options.device && source.trained && limit.relative_to != "spline")
        continue;
      throw std::invalid_argument(fmt::format(
          "{}: the limit of {} is relative to the {}, which is trained on the "
          "[[training]] runs of a qualification; there are none",
          limit.place, limit.metric, limit.relative_to));
    }
  }

  ResultProvenance provenance() const {
    ResultProvenance p{
        .program_version = kProgramVersion,
        .git_revision = kGitRevision,
        .device = options.device
                      ? fs::path(options.device->name()).filename().string()
                      : "",
        .qualification = options.qualification
                             ? options.qualification->filename().string()
                             : "",
        .specification = specification.name,
        .false_accept_risk = specification.false_accept_risk,
        .files = {},
        .seeds = {}};
    for (const ValidationInput& input : inputs)
      p.files.push_back(
          {input.group, input.path.filename().string(), input.sha256});
    for (const auto* runs : {&qualification.runs, &qualification.training,
                             &qualification.held_out, &qualification.turning})
      for (const QualificationRun& run : *runs)
        p.seeds.emplace_back(run.name, run.scenario.seed);
    return p;
  }
};

Validator::Validator(CompensatorSource source, ValidationOptions options,
                     bool keeps_inputs)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  require_sound(options);
  s.source = std::move(source);
  s.options = std::move(options);
  if (s.options.device) s.read_device();
  s.require_model_can_be_trained();
  for (const SourceText& file : s.source.files)
    s.add_file("compensator", file.path, file.text);
  if (s.options.workbench) s.read_workbench();
  if (s.options.set) s.open_set();
  s.hash_recordings(keeps_inputs);
  s.read_specification();
  if (s.options.campaign) s.read_campaign();
  s.require_baselines();
  s.isolate_code();
}

Validator::~Validator() = default;

const CompensatorSource& Validator::source() const { return state_->source; }
const ValidationOptions& Validator::options() const { return state_->options; }
const std::vector<ValidationInput>& Validator::inputs() const {
  return state_->inputs;
}

CompletedValidation Validator::validate(std::size_t threads,
                                        const ProgressOfWork& progress) const {
  const State& s = *state_;
  const double share = s.campaign ? 0.05 : 0.8;  // of the work, of the device
  const ModelSpec* model = s.source.model ? &*s.source.model : nullptr;
  const TrainingData data =
      s.options.device
          ? training_data(s.qualification, s.device, model, threads)
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
  const auto ready = declared.ready_after > 0.0
                         ? ready_compensator(*compensator, declared.ready_after)
                         : nullptr;
  const TestedCompensator& answering_one = ready ? *ready : *compensator;
  const RecordedAnswering answering{answering_one, known, s.options.full_scale};
  if (s.options.device) {
    done.evidence =
        device_evidence(s.qualification, s.device, answering_one, data,
                        known != nullptr, threads, [&](double part) {
                          if (progress) progress(share * part);
                        });
    result.warnings =
        warnings_about(s.qualification, s.device.device, done.evidence);
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
        s.options.recordings, answering, threads,
        [](const fs::path& path, std::vector<std::string>* warnings) {
          return beamgyro::read_recording(path, warnings);
        },
        result.warnings);
    s.require_same_recordings();
    for (std::string& text : warnings_about(done.evidence.before))
      result.warnings.push_back(std::move(text));
  }
  for (std::string& text : s.warnings_about_isolation())
    result.warnings.push_back(std::move(text));
  result.isolation = s.source.isolation;
  result.provenance = s.provenance();
  if (!s.set) {
    difference = s.difference_from_workbench(done.evidence);
    judge({s.specification, s.qualification.metric_runs, *compensator, known},
          done.evidence, threads, result);
  }
  result.compensator = {s.source.name, std::string(kind_name(s.source.kind)),
                        known != nullptr ? known->provenance.method : "",
                        compensator->inputs(), difference};
  if (s.campaign)
    result.population =
        population_yield({&*s.campaign, &s.qualification, &s.specification,
                          &answering_one, model, known},
                         threads, [&](double part) {
                           if (progress) progress(share + (1 - share) * part);
                         });
  require_unchanged(s.source);
  return done;
}

namespace {

using RequestValue = nlohmann::ordered_json;

// The value of a member as a bundle stores it: names of inputs for files.
RequestValue stored_value(const ValidationMember& row,
                          const ValidationOptions& options,
                          const InputNames& names) {
  const std::string group(row.bundle_key);
  const auto name_of = [&](const fs::path& path) {
    return RequestValue(names.at({group, path}));
  };
  return std::visit(
      [&](auto member) -> RequestValue {
        const auto& value = options.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::vector<fs::path>>) {
          RequestValue list = RequestValue::array();
          for (const fs::path& path : value) list.push_back(name_of(path));
          return list;
        } else if constexpr (requires { value.has_value(); }) {
          if (!value) return nullptr;
          if constexpr (std::is_same_v<Value, std::optional<fs::path>>)
            return name_of(*value);
          else if constexpr (std::is_same_v<Value, std::optional<Device>>)
            return name_of(value->name());
          else if constexpr (std::is_same_v<Value, std::optional<Set>>)
            throw std::logic_error("a set is in no bundle");
          else
            return *value;
        } else {
          return value;
        }
      },
      row.member);
}

fs::path listed_path(const Bundle& bundle, const JsonNode& node) {
  return bundle.directory / listed_name(bundle, node);
}

void read_value(const ValidationMember& row, const Bundle& bundle,
                const JsonNode& node, ValidationOptions& options) {
  std::visit(
      [&](auto member) {
        auto& value = options.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, std::vector<fs::path>>) {
          for (const JsonNode& one : node.elements())
            value.push_back(listed_path(bundle, one));
        } else if (node.is_null()) {
          return;
        } else if constexpr (std::is_same_v<Value, std::optional<fs::path>>) {
          value = listed_path(bundle, node);
        } else if constexpr (std::is_same_v<Value, std::optional<Device>>) {
          value = Device::read(listed_path(bundle, node));
        } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
          value = node.number();
          if (!(*value > 0)) node.fail("expected a number above 0");
        } else if constexpr (std::is_same_v<Value,
                                            std::optional<std::uint32_t>>) {
          value = static_cast<std::uint32_t>(node.integer(1, kMostDevices));
        } else {
          node.fail("expected none, in a bundle");
        }
      },
      row.member);
}

}  // namespace

nlohmann::ordered_json request_json(const Validator& validator,
                                    const InputNames& names) {
  const CompensatorSource& source = validator.source();
  RequestValue json{
      {"compensator", source.files.empty()
                          ? source.argument
                          : names.at({"compensator", source.argument})}};
  for (const ValidationMember& row : validation_members())
    if (!row.bundle_key.empty())
      json[std::string(row.bundle_key)] =
          stored_value(row, validator.options(), names);
  return json;
}

BundledRequest request_of(const Bundle& bundle) {
  const JsonNode node(bundle.request, (bundle.directory / kBundleFile).string(),
                      "request");
  BundledRequest request;
  const JsonNode compensator = node.at("compensator");
  request.compensator = compensator.text();
  if (source_kind(request.compensator) != SourceKind::kCommand)
    request.compensator = listed_path(bundle, compensator).string();
  std::vector<std::string> known{"compensator"};
  for (const ValidationMember& row : validation_members()) {
    if (row.bundle_key.empty()) continue;
    known.emplace_back(row.bundle_key);
    read_value(row, bundle, node.at(known.back()), request.options);
  }
  for (const auto& [key, value] : bundle.request.items())
    if (std::ranges::count(known, key) == 0)
      node.fail(fmt::format("\"{}\": unknown key", key));
  try {
    require_sound(request.options);
  } catch (const std::invalid_argument& error) {
    node.fail(error.what());
  }
  return request;
}

BundleContent bundle_content(const Validator& validator) {
  return {validator.inputs(),
          [&validator](const InputNames& names) {
            return request_json(validator, names);
          },
          kProgramVersion, kGitRevision};
}

}  // namespace beamgyro::internal
