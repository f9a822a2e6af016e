// SPDX-License-Identifier: MIT
#include "validation/external/command_compensator.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "dataset/files/number_text.h"
#include "dataset/recording/signals.h"
#include "validation/external/answering.h"
#include "validation/external/conversation.h"
#include "validation/external/measured_signals.h"
#include "validation/external/plugin_host.h"

namespace beamgyro::internal {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

class CsvLanguage : public AnswerLanguage {
 public:
  void start(const Recording& run, double /*period*/,
             std::string& bytes) override {
    run_ = &run;
    const std::vector<std::string> names = measured_names(*run_);
    signals_ = MeasuredSignals(*run_, names);
    fmt::format_to(std::back_inserter(bytes), "time,{}\n",
                   fmt::join(names, ","));
  }

  void sample(std::size_t k, std::string& bytes) override {
    auto end = std::back_inserter(bytes);
    fmt::format_to(end, "{}", run_->time[k]);
    for (std::size_t i = 0; i < signals_.count(); ++i)
      fmt::format_to(end, ",{}", signals_.at(i, k));
    bytes += '\n';
  }

  std::optional<WrittenAnswer> answer(std::string_view& bytes,
                                      bool at_end) override {
    const std::size_t end = bytes.find('\n');
    if (end == bytes.npos && (!at_end || bytes.empty())) return std::nullopt;
    const std::string_view line = trimmed(bytes.substr(0, end));
    bytes.remove_prefix(end == bytes.npos ? bytes.size() : end + 1);
    const std::optional<double> rate = number_in(line);
    return WrittenAnswer{rate, rate ? std::string() : std::string(line)};
  }

 private:
  const Recording* run_ = nullptr;
  MeasuredSignals signals_;
};

class CommandCompensator : public TestedCompensator {
 public:
  CommandCompensator(ProcessStart start, ProcessLimits limits)
      : start_(std::move(start)), limits_(std::move(limits)) {}

  std::vector<std::string> inputs() const override {
    std::vector<std::string> names;
    for (const RecordedSignal& signal : recorded_signals())
      if (signal.role == Role::kMeasured) names.emplace_back(signal.name);
    return names;
  }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all(runs.size());
    for (std::size_t k = 0; k < runs.size(); ++k) fill(*runs[k], all[k]);
    return all;
  }

 private:
  void fill(const Recording& run, Answer& answer) const {
    const Stopwatch watch;
    const std::vector<AskedStretch> stretches = asked_stretches(run, answer);
    for (const AskedStretch& stretch : stretches)
      if (!ask(stretch)) break;
    answer.seconds = watch.seconds();
    if (answer.seconds > duration_with_last_sample(run) &&
        answer.faults.empty())
      answer.seconds -=
          static_cast<double>(stretches.size()) * start_of(stretches[0]);
    add_fault_of_values(run, answer);
    add_fault_of_speed(run, answer);
  }

  bool ask(const AskedStretch& stretch) const {
    CsvLanguage language;
    return converse(start_, language, {stretch}, limits_);
  }

  // Returns the seconds until a process has answered one sample: what its start
  // takes, which is no part of its speed.
  double start_of(AskedStretch stretch) const {
    Answer ignored;
    ignored.rate.assign(stretch.run->time.size(), NAN);
    stretch.answer = &ignored;
    stretch.samples.end = stretch.samples.begin + 1;
    const Stopwatch watch;
    ask(stretch);
    return watch.seconds();
  }

  ProcessStart start_;
  ProcessLimits limits_;
};

}  // namespace

std::string command_of(const std::string& argument) {
  std::string command = argument.substr(argument.find(':') + 1);
  if (trimmed(command).empty())
    throw std::invalid_argument(
        "cmd: no command; expected \"cmd:PROGRAM ARGS\"");
  return command;
}

AnsweringProcess command_process(const std::string& argument,
                                 const ProcessLimits& limits,
                                 const Isolation& isolation) {
  const std::string command = command_of(argument);
  if (!limits.program.empty())
    return {host_start(limits, isolation, HostTask::kCommand, command),
            std::make_unique<CsvLanguage>(), false};
  std::string script = "ulimit -c 0\n";
  if (limits.memory > 0)
    script += fmt::format("ulimit -v {}\n", limits.memory / 1024);
  return {{{"/bin/sh", "-c", script + command}},
          std::make_unique<CsvLanguage>(),
          false};
}

std::unique_ptr<TestedCompensator> open_command(const std::string& argument,
                                                const ProcessLimits& limits,
                                                const Isolation& isolation) {
  return std::make_unique<CommandCompensator>(
      command_process(argument, limits, isolation).start, limits);
}

}  // namespace beamgyro::internal
