// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/recorded_runs.h"
#include "cli/terminal.h"
#include "compensation/compensator_file.h"
#include "compensation/set_runs.h"
#include "compensation/set_scores.h"
#include "compensation/validation_report.h"
#include "dataset/atomic_file.h"
#include "dataset/hdf5_file.h"
#include "dataset/sha256.h"

namespace beamgyro {
namespace {

constexpr int kSpecificationNotMet = 3;

struct ValidateArguments {
  std::string compensator, json;
  std::vector<std::string> runs;
  std::vector<std::string> set_runs;       // names, of a set
  std::vector<std::uint32_t> set_devices;  // of a set
};

bool was_trained_on(const Provenance& provenance, const std::string& path) {
  const std::string hash = sha256_of_file(path);
  const auto is_it = [&](const SourceFile& file) {
    return file.sha256 == hash;
  };
  return std::any_of(provenance.training.begin(), provenance.training.end(),
                     is_it) ||
         std::any_of(provenance.held_out.begin(), provenance.held_out.end(),
                     is_it);
}

// Scores of the devices nothing was trained on, or of those asked for.
int validate_on_set(const ValidateArguments& arguments,
                    const Compensator& compensator) {
  if (!arguments.json.empty())
    require_output(arguments.json, {arguments.compensator});
  SetSelection selection{{}, arguments.set_runs, arguments.set_devices};
  if (arguments.set_devices.empty()) selection.part = SetPartNumber::kTest;
  const RunSource source = runs_of_set(arguments.runs[0], selection);
  std::optional<Progress> progress("validating " + arguments.compensator);
  const std::vector<DeviceScore> scores = score_devices(compensator, source);
  if (!arguments.json.empty())
    write_text_file(
        arguments.json,
        nlohmann::ordered_json{{"set", source.set->name},
                               {"manifest_sha256", source.set->manifest_sha256},
                               {"devices", to_json(scores)}}
                .dump(2) +
            "\n");
  progress.reset();
  const auto clamped =
      std::count_if(scores.begin(), scores.end(),
                    [](const DeviceScore& score) { return score.clamped > 0; });
  if (clamped > 0)
    print_warning(fmt::format(
        "{} of {} runs have samples outside {:g} to {:g} degC, the "
        "temperatures seen in training; clamped",
        clamped, scores.size(), compensator.temperature_range.lowest,
        compensator.temperature_range.highest));
  print_result(device_table(scores));
  const bool passed =
      std::all_of(scores.begin(), scores.end(),
                  [](const DeviceScore& score) { return score.passed; });
  return passed ? 0 : kSpecificationNotMet;
}

int run_validation(const ValidateArguments& arguments) {
  const Compensator compensator = read_compensator(arguments.compensator);
  if (is_set(arguments.runs)) return validate_on_set(arguments, compensator);
  if (!arguments.set_runs.empty() || !arguments.set_devices.empty())
    throw std::invalid_argument(
        "--run and --device choose from a set, and there is none");
  std::optional<Progress> progress("validating " + arguments.compensator);
  std::deque<Recording> recordings;  // stable addresses
  std::vector<NamedRecording> runs;
  std::size_t clamped = 0, seen = 0;
  for (const std::string& path : arguments.runs) {
    recordings.push_back(read_recording(path));
    runs.push_back(
        {std::filesystem::path(path).filename().string(), &recordings.back()});
    clamped += clamped_samples(compensator, recordings.back());
    if (was_trained_on(compensator.provenance, path)) ++seen;
  }
  if (!arguments.json.empty()) {
    std::vector<std::filesystem::path> inputs(arguments.runs.begin(),
                                              arguments.runs.end());
    inputs.emplace_back(arguments.compensator);
    require_output(arguments.json, inputs);
  }

  const Validation validation = validate(
      compensator, std::filesystem::path(arguments.compensator).stem().string(),
      runs);
  if (!arguments.json.empty()) {
    write_text_file(arguments.json, to_json(validation).dump(2) + "\n");
  }
  progress.reset();
  if (clamped > 0) {
    print_warning(fmt::format(
        "{} samples lie outside {:g} to {:g} degC, the temperatures seen in "
        "training; clamped",
        clamped, compensator.temperature_range.lowest,
        compensator.temperature_range.highest));
  }
  if (seen > 0) {
    print_warning(fmt::format(
        "{} of {} runs were used in training: these scores are in-sample and "
        "flatter the compensator",
        seen, runs.size()));
  }
  print_result(table(validation));
  return validation.passed() ? 0 : kSpecificationNotMet;
}

}  // namespace

void add_validate(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* command = program.add_subcommand(
      "validate",
      "Score a compensator against the true rate; status 3 when it fails");
  command->add_option("compensator", arguments->compensator, "COMPENSATOR.json")
      ->required();
  command
      ->add_option("runs", arguments->runs,
                   "RUN.h5..., which training must not have seen, or the "
                   "directory of a set: its test devices")
      ->required();
  command->add_option("--run", arguments->set_runs,
                      "NAME of a run of the set, all without");
  command->add_option("--device", arguments->set_devices,
                      "NUMBER of a device of the set, in place of those for "
                      "testing");
  command->add_option("--json", arguments->json,
                      "FILE, every score in machine-readable form");
  command->callback([arguments, &action] {
    action = [arguments] { return run_validation(*arguments); };
  });
}

}  // namespace beamgyro
