// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "api/compensators.h"
#include "compensation/inputs/sample_ranges.h"
#include "validation/external/answering.h"
#include "validation/external/measured_signals.h"

namespace beamgyro::internal {
namespace {

// Names a sample, and the run that it is of where that is known.
std::string asked_sample_words(const Recording& run, std::size_t sample) {
  return sample_words(run, sample) + (run.run.empty() ? "" : " of " + run.run);
}

constexpr double kNoAnswer = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::vector<T> part_of(const std::vector<T>& all, const SampleRange& range) {
  return {all.begin() + static_cast<std::ptrdiff_t>(range.begin),
          all.begin() + static_cast<std::ptrdiff_t>(range.end)};
}

/// What a compensator of the user is given: no truth and no text of files.
Recording seen_part(const Recording& run,
                    const std::vector<std::string>& inputs,
                    const SampleRange& range) {
  Recording seen;
  seen.run = run.run;
  seen.time = part_of(run.time, range);
  seen.status = part_of(run.status, range);
  for (const Column& column : run.columns) {
    const bool is_input =
        inputs.empty() || std::ranges::count(inputs, column.name) > 0;
    if (column.role == Role::kMeasured && is_input)
      seen.columns.push_back({column.name, column.units, column.long_name,
                              column.role, part_of(column.values, range),
                              column.comment});
  }
  return seen;
}

/// A class of the user's own.
class UserCompensator final : public TestedCompensator {
 public:
  explicit UserCompensator(const RateCompensator& user) : user_(user) {}

  std::vector<std::string> inputs() const override { return user_.inputs(); }
  bool is_timed() const override { return false; }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all;
    for (const Recording* run : runs) all.push_back(answer_to(*run));
    return all;
  }

 private:
  Answer answer_to(const Recording& run) const {
    const std::vector<std::string> names = user_.inputs();
    const MeasuredSignals all_there(run, names);  // or throws
    const Stopwatch watch;
    Answer answer;
    answer.rate.assign(run.time.size(), kNoAnswer);
    for (const SampleRange& stretch : powered_stretches(run))
      take(run, stretch, user_.answer(seen_part(run, names, stretch)), answer);
    answer.seconds = watch.seconds();
    add_fault_of_values(run, answer);
    return answer;
  }

  // Throws std::invalid_argument for sigmas that are too few or not above 0.
  void require_sigma(const Recording& run, const SampleRange& stretch,
                     const std::vector<double>& sigma) const {
    if (sigma.empty()) return;
    if (sigma.size() != stretch.size())
      throw std::invalid_argument(
          fmt::format("{}: gave {} sigmas to the {} samples from {}",
                      user_.name(), sigma.size(), stretch.size(),
                      asked_sample_words(run, stretch.begin)));
    for (std::size_t k = 0; k < sigma.size(); ++k)
      if (!(sigma[k] > 0.0 && std::isfinite(sigma[k])))
        throw std::invalid_argument(fmt::format(
            "{}: gave a sigma of {} deg/s to {}; expected a finite value above "
            "0",
            user_.name(), sigma[k],
            asked_sample_words(run, stretch.begin + k)));
  }

  void take(const Recording& run, const SampleRange& stretch,
            const CompensatedRate& part, Answer& answer) const {
    const auto place = static_cast<std::ptrdiff_t>(stretch.begin);
    std::ranges::copy_n(
        part.rate.begin(),
        static_cast<std::ptrdiff_t>(std::min(part.rate.size(), stretch.size())),
        answer.rate.begin() + place);
    require_sigma(run, stretch, part.sigma);
    if (!part.sigma.empty()) {
      answer.sigma.resize(run.time.size(), kNoAnswer);
      std::ranges::copy(part.sigma, answer.sigma.begin() + place);
    }
    answer.clamped += part.clamped;
    for (const std::string& words : part.faults)
      answer.faults.push_back({AnswerFault::kReported, stretch.begin, words});
    if (part.rate.size() == stretch.size() || !answer.faults.empty()) return;
    const bool too_few = part.rate.size() < stretch.size();
    answer.faults.push_back(
        {too_few ? AnswerFault::kTooFew : AnswerFault::kTooMany, stretch.begin,
         fmt::format("gave {} answers to the {} samples from {}",
                     part.rate.size(), stretch.size(),
                     sample_words(run, stretch.begin))});
  }

  const RateCompensator& user_;
};

}  // namespace

std::vector<std::string> OpenedCompensator::inputs() const {
  return source_.tested->inputs();
}

CompensatedRate OpenedCompensator::answer(const Recording& recording) const {
  require_sound(recording, "the recording");
  return public_answer(source_.tested->answer(recording));
}

CompensatorSource source_of(const RateCompensator& compensator) {
  if (const auto* file = dynamic_cast<const Compensator*>(&compensator))
    return source_of(file->content().compensator, file->content().path(),
                     file->text());
  if (const auto* opened = dynamic_cast<const OpenedCompensator*>(&compensator))
    return opened->source();
  return source_of(std::make_shared<UserCompensator>(compensator),
                   compensator.name());
}

CompensatedRate public_answer(Answer answer) {
  CompensatedRate all{
      std::move(answer.rate), std::move(answer.sigma), answer.clamped, {}};
  for (SeenFault& seen : answer.faults)
    all.faults.push_back(std::move(seen.words));
  return all;
}

}  // namespace beamgyro::internal
