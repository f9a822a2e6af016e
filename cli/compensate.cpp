// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/compensators.h"
#include "cli/answer_stream.h"
#include "cli/commands.h"
#include "cli/hidden_process.h"
#include "cli/inputs.h"
#include "cli/process_limits.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "include/beamgyro/compensator.h"
#include "validation/external/compensator_source.h"
#include "validation/external/compensator_stream.h"

namespace beamgyro::internal {
namespace {

constexpr int kCompensatorFailed = 3;

struct CompensateArguments {
  std::string compensator, run, output;
  bool stream = false;
  std::optional<double> rate;  // [Hz]
  LimitArguments limits;
  IsolationOptions isolation;
};

int compensate(const CompensateArguments& arguments) {
  const ProcessLimits limits =
      process_limits(arguments.limits, arguments.isolation);
  hide_from_code(arguments.compensator, limits);
  const auto compensator = open_compensator(
      arguments.compensator, {.stall_s = limits.stall,
                              .memory = limits.memory,
                              .program = limits.program,
                              .plugin_files = limits.isolation.plugin_files,
                              .hidden_files = {arguments.run},
                              .require_isolation = limits.isolation.required});
  std::optional<Progress> progress("compensating " + arguments.run);
  Recording recording = load_recording(arguments.run);
  std::vector<std::filesystem::path> inputs = {arguments.run};
  if (source_kind(arguments.compensator) != SourceKind::kCommand)
    inputs.emplace_back(arguments.compensator);
  require_output(arguments.output, inputs);
  require_recording_name(arguments.output);
  std::vector<std::string> faults;
  const CompensatedRun run =
      compensated(*compensator, std::move(recording), arguments.run, faults);
  progress.reset();
  for (const std::string& words : faults)
    print_error(fmt::format("{}: {}", arguments.compensator, words));
  if (!faults.empty()) return kCompensatorFailed;
  for (const std::string& warning : run.warnings) print_warning(warning);
  write_recording(run.recording, arguments.output);
  return 0;
}

int stream_answers(const CompensateArguments& arguments) {
  const auto stream = open_compensator_stream(
      arguments.compensator,
      process_limits(arguments.limits, arguments.isolation),
      arguments.rate ? std::optional(1.0 / *arguments.rate) : std::nullopt);
  return answer_stream(*stream, arguments.compensator) ? 0 : kCompensatorFailed;
}

int compensate_any(const CompensateArguments& arguments) {
  const bool none_named = arguments.run.empty() && arguments.output.empty();
  const bool both_named = !arguments.run.empty() && !arguments.output.empty();
  if (!(arguments.stream ? none_named : both_named))
    throw std::invalid_argument(
        arguments.stream
            ? "--stream reads standard input and writes standard output; "
              "expected neither RUN.h5 nor -o"
            : "RUN.h5 or -o is missing; expected beamgyro compensate "
              "COMPENSATOR RUN.h5 -o OUT.h5, or beamgyro compensate "
              "COMPENSATOR --stream");
  require_limits_for_code(arguments.limits, arguments.compensator);
  if (arguments.stream) return stream_answers(arguments);
  if (arguments.rate) throw std::invalid_argument("--rate-Hz is for --stream");
  return compensate(arguments);
}

}  // namespace

void add_compensate(CommandLine& program) {
  const auto [command, arguments] = program.add<CompensateArguments>(
      "compensate", kCompensation,
      "Copies a recording and adds the compensated rate", compensate_any);
  command.text(
      {"COMPENSATOR", "",
       "FILE.json of train, a shared library ./FILE.so with the functions of "
       "beamgyro/plugin.h, or \"cmd:PROGRAM ARGS\", which reads CSV and writes "
       "one rate a line"},
      arguments.compensator);
  command.reads({{FileKind::kCompensator}});
  command.text({"RUN.h5", "", "Recording", "none, with --stream"},
               arguments.run);
  command.reads({{FileKind::kRecording}});
  command.text(
      {"-o,--output", "OUT.h5", "Recording to write", "none, with --stream"},
      arguments.output);
  command.flag({"--stream", "",
                "Reads samples as CSV on standard input, a line of names "
                "first, and answers each on standard output at once"},
               arguments.stream);
  command.number({"--rate-Hz", "F", "Sample rate of the stream, for a library",
                  "that of its first two samples"},
                 arguments.rate, positive());
  add_process_limits(command, arguments.limits);
  command.texts({"--plugin-files", "PATH",
                 "File or folder that it may read; may be repeated",
                 "the system and the scripts that it names"},
                arguments.isolation.plugin_files);
  command.flag({"--require-isolation", "", "Runs no code that is not isolated"},
               arguments.isolation.required);
  command.example("beamgyro compensate cubic.json flight.h5 -o compensated.h5",
                  "Adds the variable compensated_rate");
  command.example(
      "beamgyro compensate \"cmd:python3 mine.py\" flight.h5 -o mine.h5",
      "The same by a program of your own");
}

}  // namespace beamgyro::internal
