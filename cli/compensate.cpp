// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/version.h"
#include "compensation/compensator/compensator_file.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/recording/signals.h"

namespace beamgyro {
namespace {

constexpr const char* kColumn = "compensated_rate";

struct CompensateArguments {
  std::string compensator, run, output;
};

std::vector<double> answers(const Compensator& compensator,
                            const Recording& recording,
                            const std::string& file) try {
  return compensated_rate(compensator, recording);
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", file, error.what()));
}

int compensate(const CompensateArguments& arguments) {
  const Compensator compensator = read_compensator(arguments.compensator);
  std::optional<Progress> progress("compensating " + arguments.run);
  Recording recording = load_recording(arguments.run);
  require_output(arguments.output, {arguments.compensator, arguments.run});
  require_recording_name(arguments.output);
  if (find_column(recording, kColumn)) {
    throw std::invalid_argument(fmt::format(
        "{}: holds a {} already; expected a recording that was not compensated",
        arguments.run, kColumn));
  }
  std::vector<double> rate = answers(compensator, recording, arguments.run);
  progress.reset();
  if (const std::size_t clamped = clamped_samples(compensator, recording)) {
    print_warning(fmt::format(
        "{}: {} of {} samples lie outside {:g} to {:g} degC, the temperatures "
        "seen in training; clamped",
        arguments.run, clamped, recording.time.size(),
        compensator.temperature_range.lowest,
        compensator.temperature_range.highest));
  }
  recording.columns.push_back(column_of(kColumn, std::move(rate)));
  recording.compensator =
      std::filesystem::path(arguments.compensator).filename().string();
  recording.compensator_sha256 = sha256_of_file(arguments.compensator);
  if (!recording.history.empty()) recording.history += '\n';
  recording.history += history_line("compensate with " + recording.compensator);
  write_recording(recording, arguments.output);
  return 0;
}

}  // namespace

void add_compensate(CommandLine& program) {
  auto arguments = std::make_shared<CompensateArguments>();
  Command& command =
      program.add("compensate", kCompensation,
                  "Copies a recording and adds the compensated rate");
  command.argument({"COMPENSATOR.json", "", "Compensator, as written by train"},
                   arguments->compensator);
  command.reads({{FileKind::kCompensator}});
  command.argument({"RUN.h5", "", "Recording"}, arguments->run);
  command.reads({{FileKind::kRecording}});
  command.text({"-o,--output", "OUT.h5", "Recording to write"},
               arguments->output);
  command.example("beamgyro compensate cubic.json flight.h5 -o compensated.h5",
                  "Adds the variable compensated_rate");
  command.action([arguments] { return compensate(*arguments); });
}

}  // namespace beamgyro
