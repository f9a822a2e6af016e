// SPDX-License-Identifier: MIT
#include "api/validation_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "api/compensators.h"
#include "api/program_version.h"
#include "api/scenario_state.h"
#include "api/validation_members.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/compensator/run_comparison.h"
#include "config/option_message.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "dataset/set/manifest.h"
#include "validation/qualification/qualification_file.h"
#include "validation/qualification/seed_draw.h"

namespace beamgyro::internal {

namespace fs = std::filesystem;

namespace {

OwnMetricSource own_metric_source(const OwnMetric& metric) {
  if (!metric.value)
    throw std::invalid_argument(
        fmt::format("metrics: {}: has no function; expected one", metric.name));
  return {metric.name, metric.unit,
          [value = metric.value](const Evidence& evidence, JudgedRate) {
            std::vector<OwnMetricRun> runs;
            for (const EvidenceRun& run : evidence.runs)
              runs.push_back({run.name, std::string(purpose_name(run.purpose)),
                              *run.recording, run.rate});
            return value(runs);
          }};
}

}  // namespace

ValidationRequest::ValidationRequest(CompensatorSource asked,
                                     ValidationOptions with, bool keeps_inputs)
    : source(std::move(asked)), options(std::move(with)) {
  require_sound(options);
  if (options.device) read_device();
  require_model_can_be_trained();
  for (const SourceText& file : source.files)
    add_file("compensator", file.path, file.text);
  if (options.workbench)
    workbench = read_compensator_of("workbench", *options.workbench);
  if (options.against)
    against = read_compensator_of("against", *options.against);
  if (options.baseline_result) read_baseline();
  if (options.set) open_set();
  hash_recordings(keeps_inputs);
  hash_recordings_in_memory();
  read_specification();
  read_own_metrics();
  if (options.campaign) read_campaign();
  require_baselines();
  isolate_code();
}

void ValidationRequest::add_file(const std::string& group, const fs::path& path,
                                 std::string text) {
  std::string digits = sha256(text);
  inputs.push_back({group, path, std::move(digits), std::move(text)});
}

void ValidationRequest::read_device() {
  device = {options.device->content().device, options.device->text()};
  const std::vector<std::string> overrides = options.device->overrides();
  for (const std::string& line : overrides) device.overrides += line + '\n';
  qualification = read_qualification(*options.qualification);
  add_file("device", options.device->name(), options.device->text());
  for (const SourceText& file : qualification.files)
    add_file("qualification", file.path, file.text);
}

void ValidationRequest::read_specification() {
  specification = options.specification
                      ? read_specification_file(*options.specification)
                      : default_specification();
  if (options.specification)
    add_file("specification", *options.specification, specification.text);
}

void ValidationRequest::read_own_metrics() {
  const auto require_new_name = [this](const std::string& name) {
    if (std::ranges::count(own_metrics, name, &OwnMetricSource::name) > 0)
      throw std::invalid_argument(fmt::format(
          "{}: is the name of two metrics of your own; expected another one "
          "for one of them",
          name));
  };
  for (const OwnMetric& metric : options.metrics) {
    require_own_name("metrics", metric.name, metric.unit);
    require_new_name(metric.name);
    own_metrics.push_back(own_metric_source(metric));
  }
  if (options.own_metrics) {
    std::string text = read_text_file(*options.own_metrics);
    OwnMetricTable table = parse_own_metrics(text, *options.own_metrics);
    for (OwnMetricSource& metric : table.metrics) {
      require_new_name(metric.name);
      own_metrics.push_back(std::move(metric));
    }
    std::ranges::move(table.limits, std::back_inserter(specification.limits));
    add_file("own_metrics", *options.own_metrics, std::move(text));
  }
  require_own_metrics(specification.limits, own_metrics);
}

void ValidationRequest::open_set() {
  SetSelection selection{{}, options.runs, options.devices};
  if (options.devices.empty()) selection.part = SetPartNumber::kTest;
  set = runs_of_set(options.set->directory(), selection);
  // The manifest tells every file of a set.
  const fs::path manifest = options.set->directory() / kManifestName;
  add_file("runs", manifest, read_text_file(manifest));
}

void ValidationRequest::hash_recordings(bool keeps_inputs) {
  for (const fs::path& path : options.recordings) {
    recording_states.push_back(state_of_file(path));
    if (keeps_inputs)
      add_file("runs", path, read_text_file(path));
    else
      inputs.push_back({"runs", path, sha256_of_file(path), ""});
  }
}

void ValidationRequest::hash_recordings_in_memory() {
  for (const NamedRecording& run : options.recordings_in_memory) {
    require_sound(run.recording, run.name);
    inputs.push_back({"runs", run.name, measured_sha256(run.recording), ""});
  }
}

FittedCompensator ValidationRequest::read_compensator_of(
    const std::string& group, const fs::path& path) {
  const std::string text = read_compensator_text(path);
  add_file(group, path, text);
  return parse_compensator(text, path.string());
}

void ValidationRequest::read_baseline() {
  const fs::path& path = *options.baseline_result;
  const std::string text = read_json_text(path, "the result of a validation");
  earlier = parse_earlier_result(text, path.string());
  add_file("baseline_result", path, text);
}

void ValidationRequest::read_campaign() {
  campaign = CampaignPlan::read(
      *options.campaign,
      options.campaign_devices ? std::optional<long>(*options.campaign_devices)
                               : std::nullopt,
      options.seed ? std::optional(drawn_campaign_seed(*options.seed))
                   : std::nullopt);
  for (const SourceText& file : campaign->sources)
    add_file("campaign", file.path, file.text);
}

void ValidationRequest::require_same_recordings() const {
  for (std::size_t k = 0; k < options.recordings.size(); ++k) {
    const fs::path& path = options.recordings[k];
    if (state_of_file(path) != recording_states[k])
      throw std::runtime_error(path.string() + ": changed while it was read");
  }
}

// Code of others must not read what it is judged by.
void ValidationRequest::isolate_code() {
  std::vector<fs::path> hidden;
  for (const ValidationInput& input : inputs)
    if (input.group != "compensator") hidden.push_back(input.path);
  if (options.set) hidden.push_back(options.set->directory());
  isolate_code_of(source, {.plugin_files = options.plugin_files,
                           .hidden = std::move(hidden),
                           .required = options.require_isolation});
}

void ValidationRequest::require_model_can_be_trained() const {
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

// Throws when a limit is relative to a baseline that there will not be.
void ValidationRequest::require_baselines() const {
  if (!qualification.training.empty()) return;
  for (const Limit& limit : specification.limits) {
    if (limit.relative_to.empty() || limit.relative_to == "before") continue;
    const bool is_in_file =
        limit.relative_to != "spline" &&
        (limit.relative_to != "straight_lines" ||
         (source.trained && source.trained->straight_lines));
    if (!options.device && source.trained && is_in_file) continue;
    throw std::invalid_argument(fmt::format(
        "{}: the limit of {} is relative to the {}, which is trained on the "
        "[[training]] runs of a qualification; there are none",
        limit.place, limit.metric, limit.relative_to));
  }
}

ResultProvenance ValidationRequest::provenance(
    const Qualification& judged, std::optional<std::uint64_t> seed) const {
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
      .seed = seed,
      .false_accept_risk = specification.false_accept_risk,
      .files = {},
      .seeds = {}};
  for (const ValidationInput& input : inputs)
    p.files.push_back(
        {input.group, input.path.filename().string(), input.sha256});
  for (const auto* runs :
       {&judged.runs, &judged.training, &judged.held_out, &judged.turning})
    for (const QualificationRun& run : *runs)
      p.seeds.emplace_back(run.name, run.scenario.seed);
  return p;
}

}  // namespace beamgyro::internal
