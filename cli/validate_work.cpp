// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "api/bundled_request.h"
#include "api/program_version.h"
#include "api/validation_members.h"
#include "api/validator.h"
#include "cli/figure_pictures.h"
#include "cli/hidden_process.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate.h"
#include "config/readable_files.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/file_place.h"
#include "validation/bundle/bundle.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kBundleDiffers = 1, kNotWritten = 1;

ValidationOutcome judged(const Validator& validator) {
  const std::vector<std::string>& foreseen = validator.foreseen();
  for (const std::string& warning : foreseen) print_warning(warning);
  Progress progress("validating " + validator.source().argument);
  ValidationOutcome found = validated(validator, progress.shown_share());
  for (const std::string& warning : found.warnings)
    if (std::ranges::count(foreseen, warning) == 0) keep_warning(warning);
  return found;
}

std::vector<BundleOutput> outputs_of(const ValidationOutcome& found) {
  std::vector<BundleOutput> outputs{{kResultFile, found.json},
                                    {kReportFile, found.all_metrics}};
  if (!found.trained.empty()) outputs.push_back({kTrainedFile, found.trained});
  outputs.push_back({kPageFile, found.page});
  return outputs;
}

// What an option asks for.
struct AskedOutput {
  const char* option;
  std::string name;
  fs::path place;  // absolute, with links followed as far as it is there
};

void require_places_of_their_own(const ValidateArguments& arguments) {
  std::vector<AskedOutput> asked;
  for (const auto& [option, name] :
       {std::pair("--json", arguments.json),
        std::pair("--junit", arguments.junit),
        std::pair("--save-trained", arguments.trained),
        std::pair("--report", arguments.report),
        std::pair("--figures", arguments.figures),
        std::pair("--bundle", arguments.bundle)})
    if (!name.empty()) asked.push_back({option, name, canonical_place(name)});
  for (const AskedOutput& one : asked)
    for (const AskedOutput& other : asked)
      if (&one != &other && is_within(one.place, other.place))
        throw std::invalid_argument(fmt::format(
            "{} {}: is {} {} {}; expected a place of its own", one.option,
            one.name, one.place == other.place ? "the same as" : "inside",
            other.option, other.name));
}

// Throws std::invalid_argument when a file or directory that the arguments ask
// for cannot be made, is one of the inputs, or is the same as another one or
// inside it. Leaves none of them. The bundle has to be new besides
// (require_new_bundle).
void require_outputs_of(const ValidateArguments& arguments,
                        const std::vector<fs::path>& inputs) {
  require_places_of_their_own(arguments);
  require_output_directory("--report", arguments.report, "index.html", inputs);
  require_output_directory("--figures", arguments.figures, "result.json",
                           inputs);
  require_output_directory("--bundle", arguments.bundle, kBundleFile, inputs);
  require_json_output(arguments.json, inputs);
  if (!arguments.junit.empty()) require_output(arguments.junit, inputs);
  require_json_output(arguments.trained, inputs, "--save-trained");
}

// Prints a result, then writes each file and directory that is asked for. What
// fails is printed, and the others are written nevertheless. Returns the exit
// status.
int deliver(const ValidateArguments& arguments, const BundleContent& content,
            const ValidationOutcome& found) {
  int status = found.verdict == Verdict::kPass ? 0 : kNotPassed;
  const auto write = [&](bool is_asked_for, const auto& work) {
    try {
      if (is_asked_for) work();
    } catch (const std::exception& error) {
      print_error(error.what());
      status = kNotWritten;
    }
  };
  write(true, [&] {
    print_result(arguments.lines         ? found.lines
                 : arguments.all_metrics ? found.all_metrics
                                         : found.text);
  });
  write(!arguments.json.empty(),
        [&] { write_text_file(arguments.json, found.json); });
  write(!arguments.junit.empty(),
        [&] { write_text_file(arguments.junit, found.junit); });
  write(!arguments.trained.empty(),
        [&] { write_text_file(arguments.trained, found.trained); });
  write(!arguments.report.empty(), [&] {
    const MadeDirectories made(arguments.report);
    write_text_file(fs::path(arguments.report) / "index.html", found.page);
  });
  write(!arguments.bundle.empty(),
        [&] { write_bundle(arguments.bundle, content, outputs_of(found)); });
  write(!arguments.figures.empty(), [&] {
    const MadeDirectories made(arguments.figures);
    draw_figures(found.json, arguments.figures);
  });
  return status;
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

// A library is asked what it is before the validator has read everything that
// it must not read.
CompensatorSource opened(const std::string& compensator,
                         const LimitArguments& arguments,
                         const ValidationOptions& options) {
  std::vector<fs::path> hidden = options.recordings;
  if (options.device) hidden.emplace_back(options.device->name());
  if (options.set) hidden.push_back(options.set->directory());
  if (options.qualification) hidden.push_back(*options.qualification);
  const ProcessLimits limits =
      process_limits(arguments, {.plugin_files = options.plugin_files,
                                 .hidden = std::move(hidden),
                                 .required = options.require_isolation});
  hide_from_code(compensator, limits);
  return open_source(compensator, limits);
}

std::vector<fs::path> inputs_of(const Bundle& bundle) {
  std::vector<fs::path> inputs;
  for (const ListedFile& input : bundle.inputs)
    inputs.push_back(bundle.directory / input.name);
  return inputs;
}

// The options of limits are for the code of whichever bundle has some.
std::vector<BundleDifference> differences_made_again(
    const Bundle& bundle, const ValidateArguments& arguments) {
  BundledRequest request = request_of(bundle);
  require_permission(bundle, request.compensator, arguments.runs_code);
  request.options.jobs = arguments.options.jobs;
  request.options.plugin_files = arguments.options.plugin_files;
  request.options.require_isolation = arguments.options.require_isolation;
  CompensatorSource source =
      opened(request.compensator, arguments.limits, request.options);
  const Validator validator(std::move(source), std::move(request.options),
                            true);
  const BundleContent content = bundle_content(validator);
  const auto different = different_inputs(bundle, content);
  if (!different.empty()) return different;
  return different_outputs(bundle, content, outputs_of(judged(validator)));
}

std::vector<BundleDifference> differences_of(
    const Bundle& bundle, const ValidateArguments& arguments) {
  const auto different = changed_files(bundle);
  if (!different.empty()) return different;
  const ReadableFiles readable(inputs_of(bundle));
  try {
    return differences_made_again(bundle, arguments);
  } catch (const std::exception&) {
    const std::optional<fs::path> elsewhere = readable.refused();
    if (!elsewhere) throw;
    return {{*elsewhere,
             "is named by an input and not in the bundle; it was not read"}};
  }
}

}  // namespace

int judge_compensator(const ValidateArguments& arguments) {
  ValidationOptions options = validation_options(arguments);
  if (options.set && !arguments.bundle.empty())
    throw std::invalid_argument(fmt::format(
        "--bundle: {} is a set, which no bundle takes; expected recordings",
        arguments.runs[0].string()));
  require_sound(options);
  CompensatorSource source =
      opened(arguments.compensator, arguments.limits, options);
  const Validator validator(std::move(source), std::move(options),
                            !arguments.bundle.empty());
  if (!arguments.trained.empty() && !validator.source().model)
    throw std::invalid_argument(fmt::format(
        "--save-trained: {} is no model, so nothing is trained; expected a "
        "model file",
        arguments.compensator));
  const BundleContent content = bundle_content(validator);
  // The directory of a set stands for everything below it.
  std::vector<fs::path> inputs = arguments.runs;
  for (const ValidationInput& input : validator.inputs())
    inputs.push_back(input.path);
  require_outputs_of(arguments, inputs);
  if (!arguments.bundle.empty()) require_new_bundle(arguments.bundle, content);
  return deliver(arguments, content, judged(validator));
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
