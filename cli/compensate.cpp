// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "api/compensators.h"
#include "cli/commands.h"
#include "cli/hidden_process.h"
#include "cli/inputs.h"
#include "cli/process_limits.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "dataset/log/csv_file.h"
#include "dataset/log/recording_csv.h"
#include "include/beamgyro/compensator.h"
#include "validation/external/compensator_source.h"
#include "validation/external/compensator_stream.h"

namespace beamgyro::internal {
namespace {

constexpr const char* kInput = "standard input";
constexpr int kStreamFailed = 3;
constexpr int kLookEvery = 1000;  // [ms], whether the process still works

// Samples from lines of text.
class SampleLines {
 public:
  /// Returns the sample of a line, or nothing for the line of names.
  std::optional<Recording> sample(const std::string& line) {
    ++number_;
    if (header_.empty()) {
      take_names(line);
      return std::nullopt;
    }
    require_cells(line);
    const std::string text = header_ + line + (has_status_ ? "\n" : ",0\n");
    Recording read = parsed(text);
    if (!(read.time[0] > time_))
      throw std::invalid_argument(
          fmt::format("{}:{}: time {} does not follow {}; expected times that "
                      "rise",
                      kInput, number_, read.time[0], time_));
    time_ = read.time[0];
    return read;
  }

 private:
  void take_names(const std::string& line) {
    const auto names = csv_names(line + "\n", kInput);
    const auto has = [&](std::string_view wanted) {
      return std::ranges::any_of(names, [&](const std::string& cell) {
        return column_name(cell).name == wanted;
      });
    };
    if (!has("time"))
      throw std::invalid_argument(
          fmt::format("{}:1: no column time; expected a line of names such as "
                      "time,rate,temperature",
                      kInput));
    has_status_ = has("status");
    commas_ = std::ranges::count(line, ',');
    header_ = line + (has_status_ ? "\n" : ",status\n");
  }

  // The reader would count the status that is added, too.
  void require_cells(const std::string& line) const {
    const auto commas = std::ranges::count(line, ',');
    if (commas == commas_ || header_.find('"') != header_.npos) return;
    throw std::invalid_argument(
        fmt::format("{}:{}: {} cells; expected {} as in the line of names",
                    kInput, number_, commas + 1, commas_ + 1));
  }

  // Messages of the reader speak of the second line, those of the recording of
  // its only sample.
  Recording parsed(const std::string& text) const {
    try {
      return parse_recording_csv(text, kInput);
    } catch (const std::invalid_argument& error) {
      std::string message = error.what();
      const std::string second = fmt::format("{}:2", kInput);
      if (message.starts_with(second))
        message.replace(0, second.size(),
                        fmt::format("{}:{}", kInput, number_));
      else
        message = of_this_line(message);
      throw std::invalid_argument(message);
    }
  }

  // "standard input: rate: sample 0 is nan ..." with the line for the sample.
  std::string of_this_line(const std::string& message) const {
    const std::string file = fmt::format("{}: ", kInput);
    const std::string sample = ": sample 0 is ";
    const std::size_t place = message.find(sample);
    if (!message.starts_with(file) || place == message.npos) return message;
    return fmt::format("{}:{}: {} is {}", kInput, number_,
                       message.substr(file.size(), place - file.size()),
                       message.substr(place + sample.size()));
  }

  std::string header_;
  bool has_status_ = false;
  std::ptrdiff_t commas_ = 0;  // of the line of names
  std::size_t number_ = 0;
  double time_ = -std::numeric_limits<double>::infinity();
};

void print_answers(CompensatorStream& stream) {
  const std::vector<StreamAnswer> answers = stream.answers();
  if (answers.empty()) return;
  std::string text;
  for (const auto& [rate, sigma] : answers) {
    const auto out = std::back_inserter(text);
    if (stream.states_sigma())
      fmt::format_to(out, "{},{}\n", rate, sigma);
    else
      fmt::format_to(out, "{}\n", rate);
  }
  print_result(text);
}

// Appends what there is to read. Returns false at the end.
bool read_input(std::string& text) {
  std::array<char, 1 << 16> bytes;
  const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (n < 0 && errno == EINTR) return true;
  if (n < 0)
    throw std::system_error(errno, std::generic_category(),
                            "cannot read standard input");
  text.append(bytes.data(), static_cast<std::size_t>(n));
  return n > 0;
}

void take_line(std::string line, SampleLines& lines,
               CompensatorStream& stream) {
  if (line.ends_with('\r')) line.pop_back();
  if (line.find_first_not_of(" \t\r") == line.npos) return;
  if (const auto sample = lines.sample(line)) stream.take(*sample);
}

/// Reads samples as CSV on standard input, a line of names first, and prints an
/// answer for each on standard output, as soon as it is there. Where the
/// compensator states a sigma, a line of names comes first, and the sigma after
/// each rate. Returns the exit status. Throws std::invalid_argument "standard
/// input:line: ..." for what is no such CSV.
int answer_stream(CompensatorStream& stream, const std::string& compensator) {
  // A line of names, where there is more than the rate.
  if (stream.states_sigma())
    print_result("compensated_rate,compensated_rate_sigma\n");
  SampleLines lines;
  std::string text;
  bool more = true;
  while (more && !stream.fault()) {
    std::array<pollfd, 2> waits = {pollfd{STDIN_FILENO, POLLIN, 0},
                                   pollfd{stream.descriptor(), POLLIN, 0}};
    ::poll(waits.data(), waits.size(), kLookEvery);
    if (waits[0].revents != 0) more = read_input(text);
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find('\n', begin)) != text.npos;
         begin = end + 1) {
      take_line(text.substr(begin, end - begin), lines, stream);
      print_answers(stream);
    }
    text.erase(0, begin);
    stream.collect();
    print_answers(stream);
  }
  if (!stream.fault()) {
    take_line(text, lines, stream);
    stream.finish();
  }
  print_answers(stream);
  if (!stream.fault()) return 0;
  print_error(fmt::format("{}: {}", compensator, stream.fault()->words));
  return kStreamFailed;
}

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
