// SPDX-License-Identifier: MIT
#include "cli/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/option_values.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate_outputs.h"
#include "compensation/compensator/compensator_file.h"
#include "compensation/rows/recorded_runs.h"
#include "compensation/rows/set_runs.h"
#include "compensation/scoring/set_scores.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/json_text.h"
#include "dataset/files/sha256.h"
#include "parallel/work_queue.h"
#include "report/validation_report.h"
#include "validation/external/file_compensator.h"
#include "validation/metrics/metric.h"
#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"
#include "validation/result/judgement.h"
#include "validation/result/recorded_evidence.h"
#include "validation/result/result_json.h"

namespace beamgyro::internal {
namespace {

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
  require_outputs_of(arguments, inputs_of(arguments));
  const SetSelection selection = set_selection(arguments);
  const RunSource source = runs_of_set(arguments.runs[0], selection);
  std::optional<Progress> progress("validating " + arguments.compensator);
  const std::vector<DeviceScore> scores =
      score_devices(compensator, source, specification_of(arguments));
  const std::vector<std::string> warnings =
      warnings_of(compensator, source, scores);
  const bool passed =
      std::all_of(scores.begin(), scores.end(),
                  [](const DeviceScore& score) { return score.passed; });
  progress.reset();
  for (const std::string& warning : warnings) print_warning(warning);
  std::vector<std::function<void()>> files;
  if (!arguments.json.empty())
    files.emplace_back([&] {
      write_text_file(arguments.json,
                      json_text(nlohmann::ordered_json{
                          {"verdict", passed ? "pass" : "fail"},
                          {"set", source.set->name},
                          {"manifest_sha256", source.set->manifest_sha256},
                          {"warnings", warnings},
                          {"devices", to_json(scores)}}));
    });
  return deliver(device_table(scores), files, passed ? 0 : kNotPassed);
}

// Writes the metrics of the runs, and what is found of a sigma, into `json`.
void add_metrics_on_runs(const ValidateArguments& arguments,
                         const Compensator& compensator,
                         nlohmann::ordered_json& json) {
  const std::vector<std::filesystem::path> runs(arguments.runs.begin(),
                                                arguments.runs.end());
  const auto own = tested(compensator);
  const DeviceEvidence found = recorded_evidence(
      runs, {*own, &compensator, arguments.full_scale}, thread_count(0));
  json["metrics"] =
      metrics_json(metric_results(found, {}, {}, thread_count(0)), {});
  if (states_sigma(found.after))
    json["sigma"] = sigma_json(sigma_report(sigma_evidence(found.after)));
}

int validate_on_runs(const ValidateArguments& arguments) {
  const Compensator compensator = read_compensator(arguments.compensator);
  if (is_set(arguments.runs)) return validate_on_set(arguments, compensator);
  if (!arguments.set_runs.empty() || !arguments.device.empty())
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
  require_outputs_of(arguments, inputs_of(arguments));

  const Validation validation = validate(
      compensator, std::filesystem::path(arguments.compensator).stem().string(),
      runs, specification_of(arguments));
  std::string json;
  if (!arguments.json.empty()) {
    nlohmann::ordered_json all = to_json(validation);
    add_metrics_on_runs(arguments, compensator, all);
    json = json_text(all);
  }
  progress.reset();
  for (const std::string& warning : validation.warnings) print_warning(warning);
  std::vector<std::function<void()>> files;
  if (!arguments.json.empty())
    files.emplace_back([&] { write_text_file(arguments.json, json); });
  return deliver(table(validation), files,
                 validation.passed() ? 0 : kNotPassed);
}

bool is_number(const std::string& word) {
  return !word.empty() &&
         std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

// Throws when an option is given that only a simulated device has.
void require_no_device_options(const ValidateArguments& arguments) {
  const std::pair<const char*, bool> options[] = {
      {"--qualification", arguments.qualification.has_value()},
      {"--campaign", arguments.campaign.has_value()},
      {"--devices", arguments.devices.has_value()}};
  for (const auto& [name, is_given] : options)
    if (is_given)
      throw std::invalid_argument(fmt::format(
          "{} is for a simulated device; expected --device DEVICE.toml in "
          "place of {}",
          name, arguments.runs[0]));
  for (const std::string& word : arguments.device)
    if (!is_number(word))
      throw std::invalid_argument(fmt::format(
          "--device {}: of a set, a number is expected; a device file is for a "
          "call without {}",
          word, arguments.runs[0]));
  const auto number = std::ranges::find_if(arguments.runs, is_number);
  if (!arguments.device.empty() && number != arguments.runs.end())
    throw std::invalid_argument(fmt::format(
        "{0}: no recording; expected one number after each --device: --device "
        "{1} --device {0}",
        *number, arguments.device.back()));
}

// Whether the recordings are judged by metrics and checks, and not scored
// alone: when a specification or a page is asked for, and for compensators that
// are no files of this program.
bool is_judged(const ValidateArguments& arguments) {
  return arguments.specification || arguments.workbench ||
         !arguments.report.empty() || !arguments.figures.empty() ||
         !arguments.bundle.empty() || !arguments.compensator.ends_with(".json");
}

int judge_on_runs(const ValidateArguments& arguments) {
  const bool is_of_set = is_set(arguments.runs);
  if (!is_of_set && (!arguments.set_runs.empty() || !arguments.device.empty()))
    throw std::invalid_argument(
        "--run and --device choose from a set, and there is none");
  if (is_of_set && !arguments.bundle.empty())
    throw std::invalid_argument(fmt::format(
        "--bundle: {} is a set, which no bundle takes; expected recordings",
        arguments.runs[0]));
  return validate_by_specification(arguments);
}

// Whether the arguments ask for no validation.
bool asks_for_none(const ValidateArguments& arguments) {
  return arguments.compensator.empty() && arguments.device.empty() &&
         !arguments.qualification && !arguments.specification &&
         !arguments.workbench && !arguments.campaign && !arguments.devices &&
         arguments.json.empty() && arguments.report.empty() &&
         arguments.figures.empty() && arguments.bundle.empty() &&
         arguments.set_runs.empty() && !arguments.full_scale;
}

void require_list_alone(const ValidateArguments& arguments) {
  if (asks_for_none(arguments) && arguments.check.empty() && !arguments.jobs &&
      !arguments.limits.timeout && !arguments.limits.memory)
    return;
  throw std::invalid_argument(
      "--list-metrics: judges nothing; expected no other argument");
}

void require_check_alone(const ValidateArguments& arguments) {
  if (asks_for_none(arguments)) return;
  throw std::invalid_argument(fmt::format(
      "--check {}: the bundle says what is validated; expected no more than "
      "--jobs, --timeout-s and --memory-GiB beside it",
      arguments.check));
}

void require_device(const ValidateArguments& arguments) {
  if (arguments.device.empty())
    throw std::invalid_argument(
        "nothing to validate on; expected RUN.h5..., the directory of a set, "
        "or --device DEVICE.toml");
  if (arguments.device.size() > 1 || is_number(arguments.device[0]))
    throw std::invalid_argument(fmt::format(
        "--device {}: {}", arguments.device.back(),
        is_number(arguments.device[0])
            ? "a number selects a device of a set, and there is none; expected "
              "a set, or a device file (./5 for one of that name)"
            : "a second device file; expected one"));
  if (!arguments.set_runs.empty())
    throw std::invalid_argument("--run chooses from a set, and there is none");
  if (arguments.full_scale)
    throw std::invalid_argument(
        "--full-scale is for recordings; a device file says its own");
}

int validate_any(const ValidateArguments& arguments) {
  if (arguments.list_metrics) {
    require_list_alone(arguments);
    print_result(metric_list());
    return 0;
  }
  if (!arguments.check.empty()) {
    require_check_alone(arguments);
    return check_bundle(arguments);
  }
  if (arguments.compensator.empty())
    throw std::invalid_argument(
        "COMPENSATOR is missing; expected beamgyro validate COMPENSATOR "
        "RUN.h5..., beamgyro validate COMPENSATOR --device DEVICE.toml, or "
        "beamgyro validate --check DIR");
  require_limits_for_code(arguments.limits, arguments.compensator);
  if (!arguments.runs.empty()) {
    require_no_device_options(arguments);
    require_different_runs(arguments.runs);
    return is_judged(arguments) ? judge_on_runs(arguments)
                                : validate_on_runs(arguments);
  }
  require_device(arguments);
  return validate_by_specification(arguments);
}

}  // namespace

SetSelection set_selection(const ValidateArguments& arguments) {
  std::vector<long> devices;
  for (const std::string& word : arguments.device)
    devices.push_back(whole_number("--device", word, 0, kLastDevice));
  SetSelection selection{{}, arguments.set_runs, device_numbers(devices)};
  if (devices.empty()) selection.part = SetPartNumber::kTest;
  return selection;
}

void add_validate(CommandLine& program) {
  auto arguments = std::make_shared<ValidateArguments>();
  Command& command =
      program.add("validate", kCompensation,
                  "Scores a compensator against the true rate; the status is 3 "
                  "when a check fails");
  command.argument({"COMPENSATOR", "",
                    "Compensator: FILE.json as written by train, LIBRARY.so, "
                    "\"cmd:PROGRAM ARGS\", or with --device a MODEL.toml that "
                    "is trained first",
                    "none, with --check"},
                   arguments->compensator);
  command.reads({{FileKind::kCompensator, FileKind::kModel}});
  command.arguments({"RUN.h5...", "",
                     "Recordings that training has not seen, or the directory "
                     "of a set, whose test devices are scored",
                     "none, with --device DEVICE.toml"},
                    arguments->runs);
  command.reads({{FileKind::kRecording, FileKind::kSet}});
  command.number({"--full-scale", "DEG_PER_S", "Largest rate that is replayed",
                  "that of the recording's device file, or 150 for a log"},
                 arguments->full_scale, positive());
  command.text({"--json", "FILE", "Writes every figure to FILE", "no file"},
               arguments->json);
  command.group("On a simulated device");
  command.texts({"--device", "DEVICE.toml|NUMBER",
                 "Device that the qualification is simulated with; of a set "
                 "the number of a device to score, which may be repeated",
                 "the test devices of a set"},
                arguments->device);
  command.text(
      {"--qualification", "FILE.toml", "Runs that the device goes through",
       "the shipped scenarios/qualification.toml"},
      arguments->qualification);
  command.reads({{FileKind::kQualification}});
  command.text({"--spec", "SPEC.toml", "Limits that have to be met",
                "less drift than without a compensator"},
               arguments->specification);
  command.reads({{FileKind::kSpecification}});
  command.text({"--workbench", "COMPENSATOR.json",
                "Also tells the difference from this compensator, that "
                "firmware was exported from",
                "no comparison"},
               arguments->workbench);
  command.reads({{FileKind::kCompensator}});
  command.text({"--report", "DIR", "Writes the page DIR/index.html", "no page"},
               arguments->report);
  command.text({"--figures", "DIR",
                "Writes a PNG of every figure of the page to DIR; needs Python "
                "with matplotlib",
                "no pictures"},
               arguments->figures);
  command.text({"--bundle", "DIR",
                "Writes inputs, result and report to the new directory DIR",
                "no bundle"},
               arguments->bundle);
  command.text({"--campaign", "CAMPAIGN.toml",
                "Also reports how many devices of a population pass",
                "one device alone"},
               arguments->campaign);
  command.reads({{FileKind::kCampaign}});
  command.integer(
      {"--devices", "N", "Number of these devices", "that of the campaign"},
      arguments->devices, {1, 4000000000});
  command.integer({"--jobs", "N", "Number of threads", "one per core"},
                  arguments->jobs, {1, 4096});
  command.group("A result made before");
  command.text({"--check", "DIR",
                "Makes the result of a bundle again and compares every byte; "
                "the status is 1 when one differs",
                "no check"},
               arguments->check);
  command.flag({"--list-metrics", "",
                "Prints name, unit, clause of IEEE 1431, purposes of runs and "
                "definition of every metric, with tabs between, and does "
                "nothing else",
                "judges a compensator"},
               arguments->list_metrics);
  command.group("Part of a set");
  command.list({"--run", "NAME", "Run to score; may be repeated", "all runs"},
               arguments->set_runs);
  add_process_limits(command, arguments->limits);
  command.example("beamgyro validate cubic.json soak.h5 rates.h5",
                  "Prints a table and a verdict");
  command.example(
      "beamgyro validate cubic.json --device scenarios/devices/nominal.toml",
      "Simulates what the compensator has to stand");
  command.action([arguments] { return validate_any(*arguments); });
}

}  // namespace beamgyro::internal
