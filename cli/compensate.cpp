// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/compensation.h"
#include "cli/commands.h"
#include "cli/inputs.h"
#include "cli/process_limits.h"
#include "cli/progress.h"
#include "cli/stream.h"
#include "cli/terminal.h"
#include "include/beamgyro/compensator.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {
namespace {

constexpr int kCompensatorFailed = 3;

struct CompensateArguments {
  std::string compensator, run, output;
  bool stream = false;
  std::optional<double> rate;  // [Hz]
  LimitArguments limits;
};

// Prints what is wrong with the answers. Returns whether anything is.
bool report_faults(const std::string& compensator,
                   const CompensatedRate& answer) {
  for (const std::string& words : answer.faults)
    print_error(fmt::format("{}: {}", compensator, words));
  return !answer.faults.empty();
}

int compensate(const CompensateArguments& arguments) {
  const ProcessLimits limits = process_limits(arguments.limits);
  const auto compensator =
      open_compensator(arguments.compensator, {.stall_s = limits.stall,
                                               .memory = limits.memory,
                                               .program = limits.program});
  std::optional<Progress> progress("compensating " + arguments.run);
  Recording recording = load_recording(arguments.run);
  std::vector<std::filesystem::path> inputs = {arguments.run};
  if (source_kind(arguments.compensator) != SourceKind::kCommand)
    inputs.emplace_back(arguments.compensator);
  require_output(arguments.output, inputs);
  require_recording_name(arguments.output);
  require_uncompensated(recording, arguments.run);
  CompensatedRate answer =
      checked_answer(*compensator, recording, arguments.run);
  progress.reset();
  if (report_faults(arguments.compensator, answer)) return kCompensatorFailed;
  for (const std::string& warning :
       range_warnings(*compensator, answer, arguments.run))
    print_warning(warning);
  add_answer(*compensator, std::move(answer), recording);
  write_recording(recording, arguments.output);
  return 0;
}

int stream_answers(const CompensateArguments& arguments) {
  const auto stream = open_compensator_stream(
      arguments.compensator, process_limits(arguments.limits),
      arguments.rate ? std::optional(1.0 / *arguments.rate) : std::nullopt);
  return answer_stream(*stream, arguments.compensator);
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
  auto arguments = std::make_shared<CompensateArguments>();
  Command& command =
      program.add("compensate", kCompensation,
                  "Copies a recording and adds the compensated rate");
  command.argument(
      {"COMPENSATOR", "",
       "FILE.json of train, a shared library ./FILE.so with the functions of "
       "beamgyro/plugin.h, or \"cmd:PROGRAM ARGS\", which reads CSV and writes "
       "one rate a line"},
      arguments->compensator);
  command.reads({{FileKind::kCompensator}});
  command.argument({"RUN.h5", "", "Recording", "none, with --stream"},
                   arguments->run);
  command.reads({{FileKind::kRecording}});
  command.text(
      {"-o,--output", "OUT.h5", "Recording to write", "none, with --stream"},
      arguments->output);
  command.flag({"--stream", "",
                "Reads samples as CSV on standard input, a line of names "
                "first, and answers each on standard output at once"},
               arguments->stream);
  command.number({"--rate-Hz", "F", "Sample rate of the stream, for a library",
                  "that of its first two samples"},
                 arguments->rate, positive());
  add_process_limits(command, arguments->limits);
  command.example("beamgyro compensate cubic.json flight.h5 -o compensated.h5",
                  "Adds the variable compensated_rate");
  command.example(
      "beamgyro compensate \"cmd:python3 mine.py\" flight.h5 -o mine.h5",
      "The same by a program of your own");
  command.action([arguments] { return compensate_any(*arguments); });
}

}  // namespace beamgyro::internal
