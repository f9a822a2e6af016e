// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/input_lines.h"
#include "cli/live_columns.h"
#include "cli/refused_lines.h"
#include "cli/terminal.h"
#include "include/beamgyro/gyro.h"

namespace beamgyro::internal {
namespace {

struct LiveArguments {
  std::filesystem::path device;
  std::vector<std::string> overrides;
  GyroStart start;
  bool without_noise = false, linear = false, truth = false, binary = false;
};

// The signals of an answer: all that is measured, and with `truth` some of it.
std::vector<GyroSignal> answered_signals(bool truth) {
  constexpr std::array<std::string_view, 4> kTruths = {
      "true_rate", "true_bias", "true_beam_temperature",
      "true_ambient_temperature"};
  std::vector<GyroSignal> signals;
  for (const GyroSignal& signal : gyro_signals())
    if (signal.measured != nullptr ||
        (truth && std::ranges::find(kTruths, signal.name) != kTruths.end()))
      signals.push_back(signal);
  return signals;
}

// The gyro of a stream: each line is a time and what acts until then.
class LiveGyro {
 public:
  LiveGyro(const LiveArguments& arguments)
      : device_(Device::read(arguments.device, arguments.overrides)),
        start_(arguments.start),
        linear_(arguments.linear),
        signals_(answered_signals(arguments.truth)) {
    start_.noise = !arguments.without_noise;
    Gyro(device_, start_);  // a device or option that is wrong is so at once
  }

  const TimedInputs& last() const { return last_; }

  // Throws BadLine with `place` in front; everything is as before then.
  void take(const TimedInputs& line, const std::string& place) {
    try {
      if (!gyro_) {
        GyroStart start = start_;
        start.inputs = line.inputs;
        gyro_.emplace(device_, start);
      } else {
        advance(line, place);
      }
    } catch (const BadLine&) {
      throw;
    } catch (const std::exception& error) {
      throw BadLine(LineFault::kValue,
                    fmt::format("{}: {}", place, error.what()));
    }
    last_ = line;
  }

  // The values of the answer, nan for a line that is no sample.
  std::vector<double> answer(bool is_sample) const {
    std::vector<double> values(2 + signals_.size(),
                               std::numeric_limits<double>::quiet_NaN());
    if (!is_sample) return values;
    values[0] = last_.time;
    values[1] = gyro_->now().status;
    for (std::size_t i = 0; i < signals_.size(); ++i)
      values[2 + i] = signals_[i].of(gyro_->now(), gyro_->truth());
    return values;
  }

  // The line of names of the answers.
  std::string names() const {
    std::string names = "time,status";
    for (const GyroSignal& signal : signals_)
      names += fmt::format(",{}", signal.name);
    return names + "\n";
  }

 private:
  void advance(const TimedInputs& line, const std::string& place) {
    const double duration = line.time - last_.time;
    if (!(duration > 0))
      throw BadLine(LineFault::kTime,
                    fmt::format("{}: time {} does not follow {}; expected "
                                "times that rise",
                                place, line.time, last_.time));
    gyro_->step(duration, linear_ ? last_.inputs : line.inputs, line.inputs);
  }

  Device device_;
  GyroStart start_;
  bool linear_;
  std::vector<GyroSignal> signals_;
  TimedInputs last_;
  std::optional<Gyro> gyro_;
};

std::string shown(const std::vector<double>& values, bool binary) {
  if (binary) {
    std::string bytes(values.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }
  return fmt::format("{}\n", fmt::join(values, ","));
}

// Takes one line, of which `inputs` gives the values or throws BadLine, and
// adds the answer to `text`.
template <class Inputs>
void answer_line(LiveGyro& gyro, const std::string& place, const Inputs& inputs,
                 const LiveArguments& arguments, RefusedLines& refused,
                 std::string& text) {
  bool is_sample = true;
  try {
    gyro.take(inputs(), place);
    refused.add();
  } catch (const BadLine& bad) {
    refused.add(bad);
    is_sample = false;
  }
  text += shown(gyro.answer(is_sample), arguments.binary);
}

class LineNumber {
 public:
  std::string next() { return fmt::format("standard input:{}", ++number_); }

 private:
  std::size_t number_ = 0;
};

// A line of text, without an end in it where it is no whole line.
void require_whole(const InputLine& line, const std::string& place) {
  if (line.end == LineEnd::kTooLong)
    throw BadLine(LineFault::kTooLong,
                  fmt::format("{}: a line of more than {} bytes", place,
                              kLongestInputLine));
  if (line.end == LineEnd::kCutOff)
    throw BadLine(LineFault::kCutOff,
                  fmt::format("{}: the last line has no end and may be cut "
                              "off; expected a newline",
                              place));
}

bool is_empty(const InputLine& line) {
  return line.end == LineEnd::kWhole &&
         line.text.find_first_not_of(" \t\r") == line.text.npos;
}

void answer_text(LiveGyro& gyro, const LiveArguments& arguments,
                 RefusedLines& refused) {
  InputLines input;
  LineNumber number;
  std::optional<LiveColumns> columns;
  while (!input.ended()) {
    input.read();
    std::string text;
    while (const std::optional<InputLine> line = input.next()) {
      const std::string place = number.next();
      if (is_empty(*line)) continue;
      if (!columns) {
        columns.emplace(line->text, place);
        text += gyro.names();
        continue;
      }
      answer_line(
          gyro, place,
          [&] {
            require_whole(*line, place);
            return columns->of(line->text, gyro.last(), place);
          },
          arguments, refused, text);
    }
    if (!text.empty()) print_result(text);
  }
}

// Bytes of standard input as they come.
class InputBytes {
 public:
  // Returns false at the end.
  bool read() {
    std::array<char, 1 << 16> bytes;
    const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(),
                              "cannot read standard input");
    if (n > 0) text_.append(bytes.data(), static_cast<std::size_t>(n));
    return n != 0;
  }
  // Returns the line of names when it is there, without its end.
  std::optional<std::string> line() {
    const std::size_t end = text_.find('\n');
    if (end == text_.npos) {
      if (text_.size() > kLongestInputLine)
        throw std::invalid_argument(
            fmt::format("standard input:1: a line of more than {} bytes; "
                        "expected a line of names",
                        kLongestInputLine));
      return std::nullopt;
    }
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }
  // Takes the next numbers, if they are all there.
  bool take(std::vector<double>& values) {
    const std::size_t size = values.size() * sizeof(double);
    if (text_.size() - begin_ < size) {
      text_.erase(0, begin_);
      begin_ = 0;
      return false;
    }
    std::memcpy(values.data(), text_.data() + begin_, size);
    begin_ += size;
    return true;
  }
  bool is_empty() const { return text_.size() == begin_; }

 private:
  std::string text_;
  std::size_t begin_ = 0;
};

void answer_binary(LiveGyro& gyro, const LiveArguments& arguments,
                   RefusedLines& refused) {
  InputBytes input;
  std::optional<LiveColumns> columns;
  std::vector<double> values;
  std::size_t number = 0;
  const auto place = [&number] {
    return fmt::format("standard input, record {}", ++number);
  };
  while (input.read()) {
    std::string text;
    if (!columns) {
      const std::optional<std::string> names = input.line();
      if (!names) continue;
      columns.emplace(*names, "standard input:1");
      values.resize(columns->count());
      text = gyro.names();
    }
    while (input.take(values)) {
      const std::string here = place();
      answer_line(
          gyro, here, [&] { return columns->of(values, gyro.last(), here); },
          arguments, refused, text);
    }
    if (!text.empty()) print_bytes(text);
  }
  if (!columns || input.is_empty()) return;
  std::string text;
  const std::string here = place();
  answer_line(
      gyro, here,
      [&]() -> TimedInputs {
        throw BadLine(LineFault::kCutOff,
                      fmt::format("{}: the last record is cut off; expected {} "
                                  "numbers of 8 bytes",
                                  here, values.size()));
      },
      arguments, refused, text);
  print_bytes(text);
}

int run_live(const LiveArguments& arguments) {
  LiveGyro gyro(arguments);
  RefusedLines refused;
  if (arguments.binary)
    answer_binary(gyro, arguments, refused);
  else
    answer_text(gyro, arguments, refused);
  refused.print_summary();
  return 0;
}

}  // namespace

void add_live(CommandLine& program) {
  const auto [command, arguments] = program.add<LiveArguments>(
      "live", kSimulation,
      "Answers times and motions on standard input with what a gyro shows",
      run_live);
  command.text({"DEVICE.toml", "", "Device file"}, arguments.device);
  command.reads({{FileKind::kDevice}});
  command.flag({"--linear", "",
                "Inputs go to the values of a line along straight lines; "
                "without, they are held until its time"},
               arguments.linear);
  command.flag({"--truth", "", "Adds true rate, bias and temperatures"},
               arguments.truth);
  command.flag(
      {"--binary", "", "A line of names, then doubles, in both directions"},
      arguments.binary);
  command.group("The gyro");
  command.integer({"--seed", "N", "Seed of everything random", "0"},
                  arguments.start.seed);
  command.flag({"--no-noise", "", "A gyro without noise"},
               arguments.without_noise);
  command.number({"--noise-rate-Hz", "F", "Rate at which the noise changes",
                  "one over the first step"},
                 arguments.start.noise_rate_Hz);
  command.number(
      {"--temperature-degC", "T", "Temperature of every part at the first line",
       "the ambient there"},
      arguments.start.temperature_degC);
  command.number(
      {"--age-hours", "H", "Time since the factory trim", "not known"},
      arguments.start.age_hours);
  command.texts(
      {"--set", "KEY=VALUE", "Replaces a key of the device; may be repeated",
       "the file as it is"},
      arguments.overrides);
  command.example("beamgyro live scenarios/devices/nominal.toml --seed 1",
                  "Between the output of a simulation and its input");
}

}  // namespace beamgyro::internal
