// SPDX-License-Identifier: MIT
#include "validation/external/library_compensator.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <utility>

#include "compensation/compensator/training_runs_json.h"
#include "compensation/inputs/sample_ranges.h"
#include "dataset/files/json_node.h"
#include "validation/external/answering.h"
#include "validation/external/conversation.h"
#include "validation/external/measured_signals.h"
#include "validation/external/plugin_host.h"

namespace beamgyro::internal {
namespace {

class HostLanguage : public AnswerLanguage {
 public:
  explicit HostLanguage(std::vector<std::string> names)
      : names_(std::move(names)) {}

  void start(const Recording& run, double period, std::string& bytes) override {
    run_ = &run;
    signals_ = MeasuredSignals(*run_, names_);
    append(static_cast<double>(HostRecord::kReset), bytes);
    append(period, bytes);
    for (std::size_t i = 0; i < names_.size(); ++i) append(0.0, bytes);
  }

  void sample(std::size_t k, std::string& bytes) override {
    append(static_cast<double>(HostRecord::kStep), bytes);
    append(run_->time[k], bytes);
    for (std::size_t i = 0; i < names_.size(); ++i)
      append(signals_.at(i, k), bytes);
  }

  std::optional<WrittenAnswer> answer(std::string_view& bytes,
                                      bool /*at_end*/) override {
    double rate;
    if (bytes.size() < sizeof rate) return std::nullopt;
    std::memcpy(&rate, bytes.data(), sizeof rate);
    bytes.remove_prefix(sizeof rate);
    return WrittenAnswer{rate, {}};
  }

 private:
  static void append(double value, std::string& bytes) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  std::vector<std::string> names_;
  const Recording* run_ = nullptr;
  MeasuredSignals signals_;
};

// What a library says of itself.
struct LibraryStatement {
  std::vector<std::string> names;  // of the signals that it wants
  std::optional<Provenance> training = {};
};

class LibraryCompensator : public TestedCompensator {
 public:
  LibraryCompensator(ProcessStart start, LibraryStatement statement,
                     ProcessLimits limits)
      : start_(std::move(start)),
        names_(std::move(statement.names)),
        training_(std::move(statement.training)),
        limits_(std::move(limits)) {}

  std::vector<std::string> inputs() const override { return names_; }
  bool states_inputs() const override { return true; }
  const Provenance* provenance() const override {
    return training_ ? &*training_ : nullptr;
  }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override;

 private:
  ProcessStart start_;
  std::vector<std::string> names_;
  std::optional<Provenance> training_;
  ProcessLimits limits_;
};

// A library that answers too little has ended the process by itself.
void rename_exit(std::vector<Answer>& answers) {
  for (Answer& answer : answers)
    for (SeenFault& seen : answer.faults)
      if (seen.fault == AnswerFault::kTooFew)
        seen = {AnswerFault::kCrashed, seen.sample,
                "ended its process: " + seen.words};
}

// Those without an answer because the process did not survive a run before.
void add_fault_before(std::vector<Answer>& answers) {
  for (std::size_t k = 1; k < answers.size(); ++k)
    if (answers[k].faults.empty() && !answers[k - 1].faults.empty())
      answers[k].faults.push_back(
          {answers[k - 1].faults.back().fault, 0,
           "was not asked: " + answers[k - 1].faults.back().words});
}

std::vector<Answer> LibraryCompensator::answers(
    const std::vector<const Recording*>& runs) const {
  const Stopwatch watch;
  std::vector<Answer> all(runs.size());
  std::vector<AskedStretch> stretches;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    MeasuredSignals(*runs[k], names_);  // throws for one that is missing
    const auto more = asked_stretches(*runs[k], all[k]);
    stretches.insert(stretches.end(), more.begin(), more.end());
  }
  HostLanguage language(names_);
  if (!converse(start_, language, stretches, limits_)) {
    rename_exit(all);
    add_fault_before(all);
  }
  const double share = watch.seconds() / static_cast<double>(runs.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    all[k].seconds = share;
    add_fault_of_values(*runs[k], all[k]);
    add_fault_of_speed(*runs[k], all[k]);
  }
  return all;
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

// Reads the names of signals, and after a line feed the runs of training.
LibraryStatement read_statement(const std::string& text,
                                const std::filesystem::path& library) {
  const std::size_t end = text.find('\n');
  LibraryStatement statement{split_names(text.substr(0, end))};
  if (end == std::string::npos) return statement;
  const std::string place = library.string() + ": beamgyro_plugin_training()";
  const auto json = parse_json(text.substr(end + 1), place);
  read_training_runs(JsonNode(json, place), statement.training.emplace());
  return statement;
}

ProcessStart library_start(const std::filesystem::path& library,
                           const ProcessLimits& limits,
                           const Isolation& isolation, HostTask task) {
  return host_start(limits, isolation, task,
                    std::filesystem::absolute(library).string());
}

// Asks the library what it is.
LibraryStatement described(const std::filesystem::path& library,
                           const ProcessLimits& limits,
                           const Isolation& isolation) {
  ChildProcess process(
      library_start(library, limits, isolation, HostTask::kDescribe));
  process.input().reset();
  bool in_time = true;
  std::string text = read_until_end(*process.output(), limits.stall, in_time);
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}", library.string(), why));
  };
  if (text.size() > kLongestReading)
    refuse(fmt::format("tells more than {} bytes of itself", kLongestReading));
  const std::optional<ProcessEnd> end =
      in_time ? process.wait(limits.stall) : std::nullopt;
  if (!end)
    refuse(fmt::format("cannot be loaded: hung for {:.3g} s", limits.stall));
  if (end->status == 0 && end->signal == 0) {
    if (!text.ends_with(kEndOfDescription))
      refuse("ended with status 0 before it told its signals");
    text.pop_back();
    return read_statement(text, library);
  }
  const std::string error =
      read_until_end(*process.error(), limits.stall, in_time);
  if (end->status == 2 && !error.empty()) refuse(error);
  refuse(fmt::format("cannot be loaded: {}{}", end_words(*end),
                     last_words(error)));
  return {};
}

LibraryStatement statement_of(const std::filesystem::path& library,
                              const ProcessLimits& limits,
                              const Isolation& isolation) {
  if (limits.program.empty())
    throw std::logic_error("ProcessLimits::program is not given");
  LibraryStatement statement = described(library, limits, isolation);
  try {
    for (const std::string& name : statement.names) require_measurable(name);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}: {}", library.string(), error.what()));
  }
  return statement;
}

}  // namespace

std::unique_ptr<TestedCompensator> open_library(
    const std::filesystem::path& library, const ProcessLimits& limits,
    const Isolation& isolation) {
  return std::make_unique<LibraryCompensator>(
      library_start(library, limits, isolation, HostTask::kAnswer),
      statement_of(library, limits, isolation), limits);
}

AnsweringProcess library_process(const std::filesystem::path& library,
                                 const ProcessLimits& limits,
                                 const Isolation& isolation) {
  return {library_start(library, limits, isolation, HostTask::kAnswer),
          std::make_unique<HostLanguage>(
              statement_of(library, limits, isolation).names),
          true};
}

}  // namespace beamgyro::internal
