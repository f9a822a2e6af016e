// SPDX-License-Identifier: MIT
// Checks of the way in which a compensator answers, and of its training.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compensation/compensator/run_comparison.h"
#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_injection.h"
#include "validation/checks/check_context.h"
#include "validation/checks/random_response.h"
#include "validation/checks/white_number.h"
#include "validation/external/answer_checks.h"

namespace beamgyro::internal {
namespace {

CheckResult count_result(std::size_t count, const std::string& passed,
                         const std::string& failed) {
  return {.outcome = passed_if(count == 0),
          .value = static_cast<double>(count),
          .limit = 0.0,
          .words = count == 0 ? passed : failed};
}

/// Returns the first fault of one of these kinds in the runs, with the name of
/// its run before it.
std::optional<std::string> first_words(const CheckContext& context,
                                       const std::vector<AnswerFault>& kinds) {
  for (const CheckedRun& run : context.checked.runs)
    for (const SeenFault& seen : run.answer.faults)
      if (std::ranges::find(kinds, seen.fault) != kinds.end())
        return fmt::format("Run {}: {}.", run.name, seen.words);
  return std::nullopt;
}

bool in_altered(const CheckContext& context,
                const std::vector<AnswerFault>& kinds) {
  return std::ranges::any_of(kinds, [&context](AnswerFault kind) {
    return context.altered.has_seen(kind);
  });
}

/// The result of a check that only looks for faults.
CheckResult fault_result(const CheckContext& context,
                         const std::vector<AnswerFault>& kinds,
                         const std::string& passed) {
  std::size_t runs = 0;
  for (const CheckedRun& run : context.checked.runs)
    runs += std::ranges::any_of(run.answer.faults, [&](const SeenFault& seen) {
      return std::ranges::find(kinds, seen.fault) != kinds.end();
    });
  if (runs == 0 && in_altered(context, kinds))
    return count_result(
        1, "",
        "Fails on a recording with rates added to it, which looks "
        "like any other to a compensator.");
  return count_result(runs, passed, first_words(context, kinds).value_or(""));
}

bool was_used(const CheckedCompensator& checked, const CheckedRun& run) {
  if (checked.set != nullptr && !run.device.empty()) {
    const TrainingRun of_set{.name = run.name,
                             .sha256 = "",
                             .recording = {},
                             .device = run.device,
                             .run = run.set_run};
    if (was_used_in_training(*checked.provenance, *checked.set, of_set))
      return true;
  }
  return was_used_in_training(*checked.provenance, run.sha256, *run.recording);
}

/// Returns the first file that was fitted and held out at once, whole or in
/// pieces: then its early stopping and its choices have seen the answer.
std::optional<std::string> leak(const Provenance& provenance) {
  for (const SourceFile& held : provenance.held_out)
    for (const SourceFile& fitted : provenance.training)
      if (is_same_recording(held, fitted) || is_part_of(held, fitted) ||
          is_part_of(fitted, held))
        return held.name;
  return std::nullopt;
}

}  // namespace

CheckResult check_hold_out(const CheckContext& context) {
  const Provenance* provenance = context.checked.provenance;
  const auto unknown = [&](const std::string& words) {
    CheckResult result = not_tested(words + ".");
    if (context.checked.requires_provenance)
      result = {.outcome = CheckOutcome::kFailed,
                .words = words + ", which is required here."};
    return result;
  };
  if (provenance == nullptr || !warning_of_no_training(*provenance).empty())
    return unknown("The compensator names no recording that it was trained on");
  if (context.checked.set != nullptr &&
      may_have_used(*provenance, *context.checked.set))
    return unknown(
        "The compensator was trained on this set and does not say on which "
        "devices, so that these runs may be in-sample");
  std::vector<std::string> used, sharing;
  for (const CheckedRun& run : context.checked.runs) {
    if (was_used(context.checked, run)) {
      used.push_back(run.name);
    } else if (run.device.empty()) {
      const std::string text =
          shared_seed(*provenance, run.name, *run.recording);
      if (!text.empty()) sharing.push_back(text);
    }
  }
  return count_result(
      used.size(),
      fmt::format("Training saw none of the {} runs{}{}.",
                  context.checked.runs.size(), sharing.empty() ? "" : ", but ",
                  fmt::join(sharing, "; ")),
      fmt::format("Training saw {} of the {} runs, so they prove nothing: {}.",
                  used.size(), context.checked.runs.size(),
                  fmt::join(used, ", ")));
}

namespace {

constexpr std::size_t kEnough = 100;  // samples, to cut a run

/// The runs that conduct is tried on: the one with the fewest samples, the one
/// over temperature and the one of power cycles that last longest.
std::vector<const CheckedRun*> tried_runs(const CheckContext& context) {
  const auto& runs = context.checked.runs;
  const auto chosen = [&](const auto& is_one, const auto& is_better) {
    const CheckedRun* best = nullptr;
    for (const CheckedRun& run : runs)
      if (run.recording->time.size() >= kEnough && is_one(run) &&
          (best == nullptr || is_better(*run.recording, *best->recording)))
        best = &run;
    return best;
  };
  const auto fewer = [](const Recording& one, const Recording& other) {
    return one.time.size() < other.time.size();
  };
  const auto longer = [](const Recording& one, const Recording& other) {
    return one.time.back() - one.time.front() >
           other.time.back() - other.time.front();
  };
  const auto thermal = thermal_purposes();
  std::vector<const CheckedRun*> tried;
  for (const CheckedRun* run :
       {chosen([](const CheckedRun&) { return true; }, fewer),
        chosen(
            [&](const CheckedRun& run) {
              return std::ranges::count(thermal, run.purpose) > 0;
            },
            longer),
        chosen(
            [](const CheckedRun& run) {
              return run.purpose == RunPurpose::kPowerCycle;
            },
            longer)})
    if (run != nullptr && std::ranges::count(tried, run) == 0)
      tried.push_back(run);
  return tried;
}

const std::string kTooShort = "Every run is shorter than 100 samples.";

/// The first fault that `find` sees in tried_runs().
template <class Find>
CheckResult tried_result(const CheckContext& context, const Find& find,
                         const std::string& passed) {
  const auto tried = tried_runs(context);
  if (tried.empty()) return not_tested(kTooShort);
  for (const CheckedRun* run : tried)
    if (const auto seen = find(*context.checked.compensator, *run->recording))
      return count_result(
          1, "",
          fmt::format("In {} the compensator {}.", run->name, seen->words));
  return count_result(0, passed, "");
}

}  // namespace

CheckResult check_causality(const CheckContext& context) {
  const CheckResult given =
      fault_result(context, {AnswerFault::kUsesLaterSamples}, "");
  if (!given.passed()) return given;
  if (context.checked.provenance != nullptr)
    if (const auto leaked = leak(*context.checked.provenance))
      return count_result(
          1, "",
          fmt::format("{} was fitted and held out at once: what was "
                      "chosen by it has seen the answer.",
                      *leaked));
  return tried_result(context, later_samples_used,
                      "No answer changes with a later sample.");
}

CheckResult check_reset(const CheckContext& context) {
  const CheckResult given =
      fault_result(context, {AnswerFault::kKeepsState}, "");
  if (!given.passed()) return given;
  return tried_result(context, state_kept_over_reset,
                      "The same run after a reset has the same answers.");
}

CheckResult check_answers(const CheckContext& context) {
  return fault_result(
      context,
      {AnswerFault::kCrashed, AnswerFault::kTimedOut, AnswerFault::kOutOfMemory,
       AnswerFault::kTooFew, AnswerFault::kTooMany, AnswerFault::kNotANumber,
       AnswerFault::kStopped, AnswerFault::kReported},
      "Every run is answered, one number for each sample.");
}

CheckResult check_finite(const CheckContext& context) {
  if (context.missing == 0 && context.altered.has_seen(AnswerFault::kNotFinite))
    return count_result(
        1, "",
        "An answer to a recording with rates added to it is not "
        "finite.");
  return count_result(context.missing, "Every answer is finite.",
                      fmt::format("{} of {} answers are not finite.",
                                  context.missing, context.samples));
}

namespace {

constexpr double kLongestStuck = 30.0;     // [s]
constexpr std::size_t kLeastChanges = 10;  // of the output meanwhile

/// The longest time [s] over which the answers stay the same while the rate
/// changes kLeastChanges times or more.
double longest_stuck(const Recording& run, const std::vector<double>& answers) {
  const auto& rate = column_values(run, "rate");
  double longest = 0.0;
  for (const SampleRange& stretch : powered_stretches(run)) {
    std::size_t begin = stretch.begin, changes = 0;
    for (std::size_t k = stretch.begin + 1;
         k < std::min(stretch.end, answers.size()); ++k) {
      if (answers[k] != answers[k - 1]) {
        begin = k;
        changes = 0;
      } else if (rate[k] != rate[k - 1] && ++changes >= kLeastChanges) {
        longest = std::max(longest, run.time[k] - run.time[begin]);
      }
    }
  }
  return longest;
}

/// The same with rates added, for a gyro at rest may well answer zero.
double stuck_with_rates(const CheckContext& context, const Recording& run) {
  std::vector<double> added;
  for (std::size_t k = 0; k < run.time.size(); ++k)
    added.push_back(kAddedShare * context.checked.full_scale * white_number(k));
  const auto moved = with_injected_rate(run, added);
  return moved ? longest_stuck(*moved, context.altered(*moved)) : HUGE_VAL;
}

}  // namespace

CheckResult check_output_stuck(const CheckContext& context) {
  CheckResult result{.outcome = CheckOutcome::kPassed,
                     .value = 0.0,
                     .limit = kLongestStuck,
                     .words = "The answers change when the output does."};
  for (const CheckedRun& run : context.checked.runs) {
    double stuck = longest_stuck(*run.recording, run.answer.rate);
    if (stuck > kLongestStuck)
      stuck = std::min(stuck, stuck_with_rates(context, *run.recording));
    if (stuck <= *result.value) continue;
    result.value = stuck;
    if (stuck <= kLongestStuck) continue;
    result.outcome = CheckOutcome::kFailed;
    result.words = fmt::format(
        "Run {}: the answer stays the same for {:g} s while the output "
        "changes.",
        run.name, stuck);
  }
  return result;
}

CheckResult check_real_time(const CheckContext& context) {
  if (!context.checked.compensator->is_timed())
    return not_tested("Functions and classes of a program are not timed.");
  CheckResult result =
      fault_result(context, {AnswerFault::kTooSlow, AnswerFault::kStopped},
                   "Every run is answered faster than it was recorded.");
  if (result.passed() && !context.answered())
    return not_tested("Too many answers are missing.");
  result.value.reset();
  result.limit.reset();
  return result;
}

}  // namespace beamgyro::internal
