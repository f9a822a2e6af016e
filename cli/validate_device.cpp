// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/figure_pictures.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate.h"
#include "cli/version.h"
#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "parallel/work_queue.h"
#include "report/verdict_report.h"
#include "validation/bundle/bundle.h"
#include "validation/page/figures.h"
#include "validation/page/page.h"
#include "validation/result/result_json.h"
#include "validation/result/validator.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

constexpr int kBundleDiffers = 1;

fs::path shipped_qualification() {
  const fs::path file = shipped_file("scenarios/qualification.toml");
  if (file.empty())
    throw std::invalid_argument(
        "--qualification is missing, and this program has no scenarios beside "
        "it; expected --qualification QUALIFICATION.toml");
  return file;
}

void require_campaign(const ValidateArguments& arguments) {
  if (arguments.devices && !arguments.campaign)
    throw std::invalid_argument(
        "--devices needs --campaign CAMPAIGN.toml, from which they are drawn");
}

ValidationRequest request_of(const ValidateArguments& arguments) {
  ValidationRequest request{.compensator = arguments.compensator};
  request.full_scale = arguments.full_scale;
  request.devices = arguments.devices;
  request.program_version = kProgramVersion;
  request.git_revision = kGitRevision;
  request.limits = process_limits(arguments.limits);
  if (is_set(arguments.runs)) {
    request.set = arguments.runs[0];
    request.selection = set_selection(arguments);
  } else {
    request.runs.assign(arguments.runs.begin(), arguments.runs.end());
  }
  if (arguments.runs.empty()) {
    request.device = arguments.device.at(0);
    request.qualification = arguments.qualification
                                ? fs::path(*arguments.qualification)
                                : shipped_qualification();
  }
  if (arguments.specification) request.specification = *arguments.specification;
  if (arguments.workbench) request.workbench = *arguments.workbench;
  if (arguments.campaign) request.campaign = *arguments.campaign;
  return request;
}

// Returns the largest value that a specification allows a metric, if it does.
std::optional<double> largest_allowed(const ValidationResult& result,
                                      std::string_view metric) {
  for (const auto& [limit, decision] : result.limits)
    if (limit.metric == metric && limit.relative_to.empty() && limit.most)
      return limit.most;
  return std::nullopt;
}

// Returns what --json writes and the page shows.
nlohmann::ordered_json json_of(const CompletedValidation& validation) {
  nlohmann::ordered_json json = to_json(validation.result);
  json["figures"] =
      figures_of(validation.evidence.before, validation.evidence.after);
  if (!validation.result.population) return json;
  for (const PopulationMetric& metric : validation.result.population->metrics)
    json["figures"].push_back(population_figure(
        {std::string(metric.metric->name), std::string(metric.metric->unit),
         metric.before, metric.after,
         largest_allowed(validation.result, metric.metric->name)}));
  return json;
}

std::vector<BundleOutput> outputs_of(const CompletedValidation& validation) {
  const nlohmann::ordered_json json = json_of(validation);
  return {{"result.json", json.dump(2) + "\n"},
          {"report.txt", verdict_report(validation.result)},
          {"report/index.html", page_of(json)}};
}

std::vector<BundleOutput> validated(const Validator& validator,
                                    const ValidateArguments& arguments,
                                    Conformity& verdict) {
  Progress progress("validating " + validator.request().compensator);
  const CompletedValidation validation = validator.validate(
      thread_count(static_cast<unsigned>(arguments.jobs.value_or(0))),
      [&](double share) { progress.set_share(share); });
  for (const std::string& warning : validation.result.warnings)
    keep_warning(warning);
  verdict = validation.result.verdict;
  return outputs_of(validation);
}

// Prepares what the arguments name for writing.
void require_result_places(const ValidateArguments& arguments,
                           const std::vector<InputFile>& inputs) {
  std::vector<fs::path> files;
  for (const InputFile& input : inputs) files.push_back(input.path);
  if (!arguments.bundle.empty()) require_new_bundle(arguments.bundle);
  if (!arguments.report.empty()) {
    require_directory_name(arguments.report);
    fs::create_directories(arguments.report);
    require_output(fs::path(arguments.report) / "index.html", files);
  }
  if (!arguments.figures.empty()) {
    require_directory_name(arguments.figures);
    fs::create_directories(arguments.figures);
    require_output(fs::path(arguments.figures) / "result.json", files);
  }
  if (!arguments.json.empty()) require_output(arguments.json, files);
}

}  // namespace

int validate_by_specification(const ValidateArguments& arguments) {
  require_campaign(arguments);
  const Validator validator(request_of(arguments));
  require_result_places(arguments, validator.inputs());
  Conformity verdict{};
  const std::vector<BundleOutput> outputs =
      validated(validator, arguments, verdict);
  if (!arguments.json.empty()) write_text_file(arguments.json, outputs[0].text);
  if (!arguments.report.empty())
    write_text_file(fs::path(arguments.report) / "index.html", outputs[2].text);
  if (!arguments.bundle.empty())
    write_bundle(arguments.bundle, validator, outputs);
  print_result(outputs[1].text);
  if (!arguments.figures.empty())
    draw_figures(outputs[0].text, arguments.figures);
  return verdict == Conformity::kPass ? 0 : kNotPassed;
}

int check_bundle(const ValidateArguments& arguments) {
  Bundle bundle = read_bundle(arguments.check);
  std::vector<std::string> different = std::move(bundle.changed);
  if (different.empty()) {
    bundle.request.program_version = kProgramVersion;
    bundle.request.git_revision = kGitRevision;
    bundle.request.limits = process_limits();
    const Validator validator(std::move(bundle.request));
    Conformity verdict{};
    different = different_outputs(arguments.check,
                                  validated(validator, arguments, verdict));
  }
  if (different.empty()) {
    print_result(fmt::format("{}: {} inputs and {} outputs are the same\n",
                             arguments.check, bundle.inputs.size(),
                             bundle.outputs.size()));
    return 0;
  }
  for (const std::string& name : different)
    print_result(fmt::format("{}: is not the same\n",
                             (fs::path(arguments.check) / name).string()));
  if (bundle.git_revision != kGitRevision)
    print_note(
        fmt::format("the bundle was made by beamgyro {} ({}), this is {} ({})",
                    bundle.program_version, bundle.git_revision,
                    kProgramVersion, kGitRevision));
  return kBundleDiffers;
}

}  // namespace beamgyro
