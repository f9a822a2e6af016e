// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "api/validation_texts.h"
#include "cli/figure_pictures.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate.h"
#include "cli/validate_outputs.h"
#include "cli/version.h"
#include "compensation/rows/recorded_runs.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/made_directories.h"
#include "parallel/work_queue.h"
#include "validation/bundle/bundle.h"
#include "validation/result/validator.h"

namespace beamgyro::internal {
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

std::vector<BundleOutput> outputs_of(const CompletedValidation& validation) {
  ValidationTexts texts = texts_of(validation);
  return {{kResultFile, std::move(texts.json)},
          {kReportFile, std::move(texts.text)},
          {kPageFile, std::move(texts.page)}};
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

// Returns the work of writing each file and directory that is asked for.
std::vector<std::function<void()>> writers_of(
    const ValidateArguments& arguments, const Validator& validator,
    const std::vector<BundleOutput>& outputs) {
  std::vector<std::function<void()>> writers;
  if (!arguments.json.empty())
    writers.emplace_back(
        [&] { write_text_file(arguments.json, outputs[0].text); });
  if (!arguments.report.empty())
    writers.emplace_back([&] {
      const MadeDirectories made(arguments.report);
      write_text_file(fs::path(arguments.report) / "index.html",
                      outputs[2].text);
    });
  if (!arguments.bundle.empty())
    writers.emplace_back(
        [&] { write_bundle(arguments.bundle, validator, outputs); });
  if (!arguments.figures.empty())
    writers.emplace_back([&] {
      const MadeDirectories made(arguments.figures);
      draw_figures(outputs[0].text, arguments.figures);
    });
  return writers;
}

// Says before it happens that code of whoever made the bundle is run.
void announce_code(const Bundle& bundle) {
  const std::string& compensator = bundle.request.compensator;
  if (is_command(compensator) || is_library(compensator))
    print_note(
        fmt::format("{}: runs {}", bundle.directory.string(), compensator));
}

std::vector<BundleDifference> differences_of(
    const Bundle& bundle, const ValidateArguments& arguments) {
  std::vector<BundleDifference> different = changed_files(bundle);
  if (!different.empty()) return different;
  announce_code(bundle);
  ValidationRequest request = bundle.request;
  request.program_version = kProgramVersion;
  request.git_revision = kGitRevision;
  request.limits = process_limits(arguments.limits);
  const Validator validator(std::move(request));
  different = different_inputs(bundle, validator);
  if (!different.empty()) return different;
  Conformity verdict{};
  return different_outputs(bundle, validator,
                           validated(validator, arguments, verdict));
}

}  // namespace

int validate_by_specification(const ValidateArguments& arguments) {
  require_campaign(arguments);
  const Validator validator(request_of(arguments));
  std::vector<fs::path> inputs;
  for (const InputFile& input : validator.inputs())
    inputs.push_back(input.path);
  require_outputs_of(arguments, inputs);
  if (!arguments.bundle.empty())
    require_new_bundle(arguments.bundle, validator);
  Conformity verdict{};
  const std::vector<BundleOutput> outputs =
      validated(validator, arguments, verdict);
  return deliver(outputs[1].text, writers_of(arguments, validator, outputs),
                 verdict == Conformity::kPass ? 0 : kNotPassed);
}

int check_bundle(const ValidateArguments& arguments) {
  const Bundle bundle = read_bundle(arguments.check);
  require_limits_for_code(arguments.limits, bundle.request.compensator);
  const std::vector<BundleDifference> different =
      differences_of(bundle, arguments);
  for (const auto& [file, words] : different)
    print_result(fmt::format("{}: {}\n", file.string(), words));
  if (different.empty())
    print_result(fmt::format("{}: {} inputs and {} outputs are the same\n",
                             arguments.check, bundle.inputs.size(),
                             bundle.outputs.size()));
  if (bundle.git_revision != kGitRevision ||
      bundle.program_version != kProgramVersion)
    print_note(
        fmt::format("the bundle was made by beamgyro {} ({}), this is {} ({})",
                    bundle.program_version, bundle.git_revision,
                    kProgramVersion, kGitRevision));
  return different.empty() ? 0 : kBundleDiffers;
}

}  // namespace beamgyro::internal
