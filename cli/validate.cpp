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
#include "cli/terminal.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/rows/recorded_runs.h"
#include "compensation/rows/set_runs.h"
#include "compensation/scoring/set_scores.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"
#include "report/validation_report.h"

namespace beamgyro {
namespace {

constexpr int kSpecificationNotMet = 3;

struct ValidateArguments {
  std::string compensator, json;
  std::vector<std::string> runs;
  std::vector<std::string> set_runs;  // names, of a set
  std::vector<long> set_devices;      // of a set
  std::optional<double> full_scale;   // [deg/s]
};

Specification specification_of(const ValidateArguments& arguments) {
  return {.full_scale = arguments.full_scale};
}

std::vector<std::filesystem::path> inputs_of(
    const ValidateArguments& arguments) {
  std::vector<std::filesystem::path> inputs(arguments.runs.begin(),
                                            arguments.runs.end());
  inputs.emplace_back(arguments.compensator);
  return inputs;
}

// Scores the test devices of a set, or the devices named.
int validate_on_set(const ValidateArguments& arguments,
                    const Compensator& compensator) {
  if (!arguments.json.empty()) {
    require_output(arguments.json, inputs_of(arguments));
    require_json_name(arguments.json);
  }
  SetSelection selection{
      {}, arguments.set_runs, device_numbers(arguments.set_devices)};
  if (arguments.set_devices.empty()) selection.part = SetPartNumber::kTest;
  const RunSource source = runs_of_set(arguments.runs[0], selection);
  std::optional<Progress> progress("validating " + arguments.compensator);
  const std::vector<DeviceScore> scores =
      score_devices(compensator, source, specification_of(arguments));
  const std::vector<std::string> warnings =
      warnings_of(compensator, source, scores);
  if (!arguments.json.empty())
    write_text_file(
        arguments.json,
        nlohmann::ordered_json{{"set", source.set->name},
                               {"manifest_sha256", source.set->manifest_sha256},
                               {"warnings", warnings},
                               {"devices", to_json(scores)}}
                .dump(2) +
            "\n");
  progress.reset();
  for (const std::string& warning : warnings) print_warning(warning);
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
  for (const std::string& path : arguments.runs) {
    recordings.push_back(load_recording(path));
    runs.push_back({std::filesystem::path(path).filename().string(),
                    &recordings.back(), sha256_of_file(path)});
  }
  if (!arguments.json.empty()) {
    require_output(arguments.json, inputs_of(arguments));
    require_json_name(arguments.json);
  }

  const Validation validation = validate(
      compensator, std::filesystem::path(arguments.compensator).stem().string(),
      runs, specification_of(arguments));
  if (!arguments.json.empty()) {
    write_text_file(arguments.json, to_json(validation).dump(2) + "\n");
  }
  progress.reset();
  for (const std::string& warning : validation.warnings) print_warning(warning);
  print_result(table(validation));
  return validation.passed() ? 0 : kSpecificationNotMet;
}

}  // namespace

void add_validate(CommandLine& program) {
  auto arguments = std::make_shared<ValidateArguments>();
  Command& command =
      program.add("validate", kCompensation,
                  "Scores a compensator against the true rate; the status is 3 "
                  "when a check fails");
  command.argument({"COMPENSATOR.json", "", "Compensator, as written by train"},
                   arguments->compensator);
  command.reads({{FileKind::kCompensator}});
  command.arguments({"RUN.h5...", "",
                     "Recordings that training has not seen, or the directory "
                     "of a set, whose test devices are scored"},
                    arguments->runs);
  command.reads({{FileKind::kRecording, FileKind::kSet}});
  command.number({"--full-scale", "DEG_PER_S", "Largest rate that is replayed",
                  "that of the recording's device file, or 150 for a log"},
                 arguments->full_scale, positive());
  command.text({"--json", "FILE", "Writes every score to FILE", "no file"},
               arguments->json);
  command.group("Part of a set");
  command.list({"--run", "NAME", "Run to score; may be repeated", "all runs"},
               arguments->set_runs);
  command.integers({"--device", "NUMBER", "Device to score; may be repeated",
                    "the test devices"},
                   arguments->set_devices, {0, kLastDevice});
  command.example("beamgyro validate cubic.json soak.h5 rates.h5",
                  "Prints a table and a verdict");
  command.action([arguments] { return run_validation(*arguments); });
}

}  // namespace beamgyro
