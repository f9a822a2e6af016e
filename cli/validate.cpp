// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "compensation/compensator_file.h"
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

int run_validation(const ValidateArguments& arguments) {
  const Compensator compensator = read_compensator(arguments.compensator);
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
                   "RUN.h5..., which training must not have seen")
      ->required();
  command->add_option("--json", arguments->json,
                      "FILE, every score in machine-readable form");
  command->callback([arguments, &action] {
    action = [arguments] { return run_validation(*arguments); };
  });
}

}  // namespace beamgyro
