// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "api/program_version.h"
#include "api/validation_texts.h"
#include "api/validator.h"
#include "cli/figure_pictures.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate.h"
#include "cli/validate_outputs.h"
#include "cli/version.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/made_directories.h"
#include "include/beamgyro/option_error.h"
#include "parallel/work_queue.h"
#include "validation/bundle/bundle.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kBundleDiffers = 1;

// Options of the table are spelled as its rows say; the subjects by their
// words.
std::string spelled_option(std::string_view name, std::string_view value) {
  const ValidationMember& row = member_named(name);
  if (row.option.empty() && name != "device" && name != "devices")
    return std::string(name);
  std::string words =
      "--" + std::string(row.option.empty() ? "device" : row.option);
  if (!value.empty()) words.append(" ").append(value);
  return words;
}

// A validation as files and the terminal show it.
struct ShownValidation {
  Conformity verdict;
  std::string text;  // for the terminal
  std::vector<BundleOutput> outputs;
};

ShownValidation validated(const Validator& validator, bool all_metrics) {
  Progress progress("validating " + validator.source().argument);
  const CompletedValidation validation =
      validator.validate(thread_count(validator.options().jobs),
                         [&](double share) { progress.set_share(share); });
  for (const std::string& warning : validation.result.warnings)
    keep_warning(warning);
  ValidationTexts texts = texts_of(validation);
  return {validation.result.verdict,
          all_metrics ? texts.all_metrics : std::move(texts.text),
          {{kResultFile, std::move(texts.json)},
           {kReportFile, std::move(texts.all_metrics)},
           {kPageFile, std::move(texts.page)}}};
}

// Returns the work of writing each file and directory that is asked for.
std::vector<std::function<void()>> writers_of(
    const ValidateArguments& arguments, const BundleContent& content,
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
        [&] { write_bundle(arguments.bundle, content, outputs); });
  if (!arguments.figures.empty())
    writers.emplace_back([&] {
      const MadeDirectories made(arguments.figures);
      draw_figures(outputs[0].text, arguments.figures);
    });
  return writers;
}

// Throws unless the user lets code of whoever made the bundle run.
void require_permission(const Bundle& bundle, const std::string& compensator,
                        bool runs_code) {
  if (!is_program(source_kind(compensator))) return;
  if (!runs_code)
    throw std::invalid_argument(fmt::format(
        "{0}: would run {1}, which is code of whoever made the bundle; nothing "
        "was run. Its files are those that it lists. Expected --run-code to "
        "run it",
        bundle.directory.string(), compensator));
  print_note(
      fmt::format("{}: runs {}", bundle.directory.string(), compensator));
}

std::vector<BundleDifference> differences_of(
    const Bundle& bundle, const ValidateArguments& arguments) {
  std::vector<BundleDifference> different = changed_files(bundle);
  if (!different.empty()) return different;
  BundledRequest request = request_of(bundle);
  require_limits_for_code(arguments.limits, request.compensator);
  require_permission(bundle, request.compensator, arguments.runs_code);
  request.options.jobs = static_cast<unsigned>(arguments.jobs.value_or(0));
  const Validator validator(
      open_source(request.compensator, process_limits(arguments.limits)),
      std::move(request.options), true);
  const BundleContent content = bundle_content(validator);
  different = different_inputs(bundle, content);
  if (!different.empty()) return different;
  return different_outputs(bundle, content, validated(validator, true).outputs);
}

}  // namespace

int judge_compensator(const ValidateArguments& arguments) try {
  ValidationOptions options = validation_options(arguments);
  if (options.set && !arguments.bundle.empty())
    throw std::invalid_argument(fmt::format(
        "--bundle: {} is a set, which no bundle takes; expected recordings",
        arguments.runs[0]));
  require_sound(options);
  const Validator validator(
      open_source(arguments.compensator, process_limits(arguments.limits)),
      std::move(options), !arguments.bundle.empty());
  const BundleContent content = bundle_content(validator);
  std::vector<fs::path> inputs(arguments.runs.begin(), arguments.runs.end());
  for (const ValidationInput& input : validator.inputs())
    inputs.push_back(input.path);
  // The directory of a set stands for everything below it.
  inputs.insert(inputs.end(), arguments.runs.begin(), arguments.runs.end());
  require_outputs_of(arguments, inputs);
  if (!arguments.bundle.empty()) require_new_bundle(arguments.bundle, content);
  const ShownValidation shown = validated(validator, arguments.all_metrics);
  return deliver(shown.text, writers_of(arguments, content, shown.outputs),
                 shown.verdict == Conformity::kPass ? 0 : kNotPassed);
} catch (const OptionError& error) {
  throw std::invalid_argument(error.words(spelled_option));
}

int check_bundle(const ValidateArguments& arguments) {
  const Bundle bundle = read_bundle(arguments.check);
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
