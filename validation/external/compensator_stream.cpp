// SPDX-License-Identifier: MIT
#include "validation/external/compensator_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "validation/external/command_compensator.h"
#include "validation/external/compensator_source.h"
#include "validation/external/library_compensator.h"

namespace beamgyro::internal {
namespace {

std::vector<Input> with_temperature(std::vector<Input> inputs) {
  inputs.push_back(parse_input("temperature"));
  return inputs;
}

class FileStream : public CompensatorStream {
 public:
  explicit FileStream(FittedCompensator compensator)
      : compensator_(std::move(compensator)),
        inputs_(with_temperature(compensator_.inputs)),
        features_(inputs_, compensator_.temperature_range),
        measured_(inputs_.size()),
        values_(inputs_.size()) {
    if (compensator_.sigma) sigma_.emplace(*compensator_.sigma);
  }

  void take(const Recording& sample) override;
  void skip() override { answers_.push_back({NAN}); }
  void finish() override {}
  bool states_sigma() const override { return sigma_.has_value(); }

 private:
  FittedCompensator compensator_;
  std::vector<Input> inputs_;  // with the temperature at the end
  FeatureStream features_;
  std::optional<BiasSigmaStream> sigma_;
  std::vector<double> measured_, values_;
};

void FileStream::take(const Recording& sample) {
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (!inputs_[i].column.empty())
      measured_[i] = column_values(sample, inputs_[i].column)[0];
  const double rate = column_values(sample, "rate")[0];
  if (!features_.step(sample.time[0], sample.status[0], measured_, values_)) {
    if (sigma_) sigma_->step(sample.time[0], sample.status[0], NAN);
    answers_.push_back({NAN});
    return;
  }
  const auto count = static_cast<Eigen::Index>(inputs_.size()) - 1;
  const Eigen::ArrayXXd x =
      Eigen::Map<const Eigen::ArrayXXd>(values_.data(), 1, count);
  const double bias = compensator_.bias.predict(x)(0);
  const double scale = compensator_.scale_factor
                           ? compensator_.scale_factor->at(values_.back())
                           : 1.0;
  StreamAnswer answer{(rate - bias) / scale};
  if (sigma_)
    answer.sigma = sigma_->step(sample.time[0], sample.status[0],
                                column_values(sample, "temperature")[0]) /
                   scale;
  answers_.push_back(answer);
}

// A process that is started at each power-on.
class ProcessStream : public CompensatorStream {
 public:
  ProcessStream(AnsweringProcess answering, const ProcessLimits& limits,
                std::optional<double> period)
      : answering_(std::move(answering)),
        stall_(limits.stall),
        period_(period) {}

  void take(const Recording& sample) override;
  void skip() override;
  void finish() override;
  int descriptor() const override {
    return process_ ? process_->descriptor() : -1;
  }
  void collect() override;

 private:
  void start(const Recording& sample, double period);
  void send(const Recording& sample);
  void take_answers();
  void answer_skipped();

  AnsweringProcess answering_;
  double stall_;                  // [s]
  std::optional<double> period_;  // [s]
  std::unique_ptr<Conversation> process_;
  Recording row_;                   // what the language reads, one sample
  std::optional<Recording> first_;  // kept until the second one comes
  // Numbers of the samples, from 0: those that wait for the process in asked_.
  std::size_t taken_ = 0, answered_ = 0;
  std::deque<std::size_t> asked_;
  std::size_t by_process_ = 0;  // answers that were taken from this one
};

void ProcessStream::take(const Recording& sample) {
  if (fault_) return;
  if ((sample.status[0] & kUnpowered) != 0) {
    finish();
    return skip();
  }
  asked_.push_back(taken_++);
  if (!process_ && !first_ && !period_) {
    first_ = sample;
    return;
  }
  if (first_) {
    const Recording first = *std::exchange(first_, std::nullopt);
    start(first, sample.time[0] - first.time[0]);
  } else if (!process_) {
    return start(sample, *period_);
  }
  send(sample);
}

void ProcessStream::skip() {
  if (fault_) return;
  ++taken_;
  answer_skipped();
}

void ProcessStream::start(const Recording& sample, double period) {
  by_process_ = 0;
  process_ = std::make_unique<Conversation>(
      answering_.start, *answering_.language, stall_, [this](std::size_t n) {
        const std::size_t k = n - by_process_;
        return fmt::format("sample {}", k < asked_.size() ? asked_[k] : taken_);
      });
  row_ = sample;
  answering_.language->start(row_, period, process_->queue());
  send(sample);
}

// The language keeps pointers to the columns.
void ProcessStream::send(const Recording& sample) {
  row_.time[0] = sample.time[0];
  row_.status[0] = sample.status[0];
  for (std::size_t i = 0; i < row_.columns.size(); ++i)
    row_.columns[i].values[0] = sample.columns[i].values[0];
  answering_.language->sample(0, process_->queue());
  process_->expect(1);
  process_->send();
  take_answers();
}

// An answer that is no number has a fault.
void ProcessStream::take_answers() {
  std::vector<double> rates = process_->answers();
  if (!process_->faults().empty()) {
    fault_ = process_->faults().front();
    rates.resize(std::min(rates.size(), fault_->sample - by_process_));
  }
  for (const double rate : rates) {
    answer_skipped();
    answers_.push_back({rate});
    ++answered_;
    ++by_process_;
    asked_.pop_front();
  }
  answer_skipped();
}

// Those before the next one that waits.
void ProcessStream::answer_skipped() {
  const std::size_t next = asked_.empty() ? taken_ : asked_.front();
  for (; answered_ < next; ++answered_) answers_.push_back({NAN});
}

void ProcessStream::collect() {
  if (!process_ || fault_) return;
  process_->turn(0.0, answering_.answers_at_once && !process_->complete());
  take_answers();
  if (descriptor() < 0) finish();
}

// Power was lost, or the last sample was sent, or the process ended.
void ProcessStream::finish() {
  if (first_ && !fault_) {
    const Recording only = *std::exchange(first_, std::nullopt);
    start(only, 1.0);  // no period is known
  }
  if (!process_ || fault_) return;
  process_->finish();
  take_answers();
  if (!fault_) process_.reset();
}

}  // namespace

std::unique_ptr<CompensatorStream> open_compensator_stream(
    const std::string& argument, const ProcessLimits& limits,
    std::optional<double> period) {
  switch (source_kind(argument)) {
    case SourceKind::kCommand:
      return std::make_unique<ProcessStream>(
          command_process(argument, limits,
                          isolation_of_command(argument, limits)),
          limits, 1.0);
    case SourceKind::kLibrary:
      return std::make_unique<ProcessStream>(
          library_process(argument, limits,
                          isolation_of_library(argument, limits)),
          limits, period);
    default:
      return std::make_unique<FileStream>(read_compensator(argument));
  }
}

}  // namespace beamgyro::internal
