// SPDX-License-Identifier: MIT
// What a compensator declares of its answers, and what it might declare.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_injection.h"
#include "validation/checks/check_context.h"
#include "validation/checks/random_response.h"

namespace beamgyro::internal {
namespace {

constexpr double kReadyDeparture = 0.02;  // [deg/s], of one that is not ready

CheckResult false_declaration(const std::string& words) {
  return {.outcome = CheckOutcome::kFailed, .words = words};
}

/// The first run over temperature whose first stretch lasts `least` [s].
const Recording* run_from_power_on(const CheckContext& context, double least) {
  for (const std::size_t k : context.runs_of(thermal_purposes())) {
    const Recording& run = *context.checked.runs[k].recording;
    const auto stretches = powered_stretches(run);
    if (!stretches.empty() &&
        run.time[stretches[0].end - 1] - run.time[stretches[0].begin] >= least)
      return &run;
  }
  return nullptr;
}

/// The share of a rate during the zeroing by which later answers fall; nothing
/// where no run shows it.
std::optional<double> share_taken_as_bias(const CheckContext& context) {
  const double quiet = context.declared().zeroes_at_power_on;
  const Recording* run = run_from_power_on(context, 4.0 * quiet);
  if (run == nullptr) return std::nullopt;
  const SampleRange first = powered_stretches(*run)[0];
  const double rate = kAddedShare * context.checked.full_scale;
  std::vector<double> added(run->time.size(), 0.0);
  for (std::size_t k = first.begin; k < first.end; ++k)
    if (run->time[k] - run->time[first.begin] <= quiet) added[k] = rate;
  const auto moved = with_injected_rate(*run, added);
  if (!moved) return std::nullopt;
  const std::vector<double> shown = context.altered(*moved);
  const std::vector<double> before = context.altered(*run);
  const double settled = quiet + context.declared().settling(usual_step(*run));
  double sum = 0.0, samples = 0.0;
  for (std::size_t k = first.begin; k < first.end; ++k) {
    if (run->time[k] - run->time[first.begin] <= settled) continue;
    sum += before[k] - shown[k];
    samples += 1.0;
  }
  if (samples == 0.0) return std::nullopt;
  return sum / (samples * rate);
}

/// Whether the answers of every run are as good in the first half of the
/// declared time as they are later.
bool is_ready_before(const CheckContext& context) {
  const double declared = context.declared().ready_after;
  bool seen = false;
  for (const std::size_t k : context.runs_of(thermal_purposes())) {
    const Recording& run = *context.checked.runs[k].recording;
    Answer raw = context.checked.compensator->answer(run);
    raw.rate.resize(run.time.size(), std::nan(""));
    for (const SampleRange& stretch : powered_stretches(run))
      for (std::size_t j = stretch.begin; j < stretch.end; ++j) {
        if (run.time[j] - run.time[stretch.begin] > 0.5 * declared) break;
        seen = true;
        if (!(std::abs(raw.rate[j] - context.answers[k][j]) <=
              kReadyDeparture + context.resolution()))
          return false;
      }
  }
  return seen;
}

}  // namespace

CheckResult check_declared(const CheckContext& context) {
  const DeclaredResponse& declared = context.declared();
  if (declared.empty())
    return {.outcome = CheckOutcome::kPassed,
            .words = "No response is declared."};
  if (context.coarsest_step() < 0.5 * declared.resolution)
    return false_declaration(fmt::format(
        "A resolution of {:.3g} deg/s is declared, but the answers step by "
        "{:.3g} deg/s.",
        declared.resolution, context.coarsest_step()));
  if (declared.zeroes_at_power_on > 0.0) {
    const auto share = share_taken_as_bias(context);
    if (share && *share < 0.5)
      return false_declaration(fmt::format(
          "Zeroing over {:g} s after a power-on is declared, but of a rate "
          "there later answers lose {:.3g}, must be 0.5 or more.",
          declared.zeroes_at_power_on, *share));
  }
  if (declared.ready_after > 0.0 && is_ready_before(context))
    return false_declaration(fmt::format(
        "Answers are declared to be ready after {:g} s, but those of the first "
        "half of that time are as good as later ones.",
        declared.ready_after));
  return {.outcome = CheckOutcome::kPassed,
          .words = fmt::format("Judged with what is declared: {}.",
                               declared.words())};
}

namespace {

constexpr double kMargin = 0.1;                // [-], of a suggested bound
constexpr double kWhole = 0.995;               // [-], gain without a low-pass
constexpr double kLeastDelay = 1e-5;           // [s]
constexpr double kLongestFilterStep = 0.101;   // [s]
constexpr double kLongestAfterPowerOn = 60.0;  // [s]

/// Few runs that show what a declaration explains, so that several are tried in
/// little time: the fastest one, the shortest one over temperature, and one
/// with random rates.
CheckedCompensator few_runs(const CheckContext& context) {
  CheckedCompensator few = context.checked;
  const auto& runs = context.checked.runs;
  std::optional<std::size_t> thermal;
  for (const std::size_t k : context.runs_of(thermal_purposes()))
    if (runs[k].recording->time.size() >= 100 &&
        (!thermal || runs[k].recording->time.size() <
                         runs[*thermal].recording->time.size()))
      thermal = k;
  std::set<std::size_t> chosen = {fastest_run(context)};
  if (thermal) chosen.insert(*thermal);
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (runs[k].purpose == RunPurpose::kRandomRate) {
      chosen.insert(k);
      break;
    }
  few.runs.clear();
  for (const std::size_t k : chosen) few.runs.push_back(runs[k]);
  return few;
}

bool passes(CheckedCompensator few, const DeclaredResponse& declared,
            std::size_t threads) {
  few.declared = declared;
  CheckContext context(few, threads);
  if (!context.answered()) return false;
  context.random = random_response(context);
  for (const auto check :
       {check_injection, check_jacobian, check_shuffled_output,
        check_rate_correlation, check_output_stuck, check_finite})
    if (check(context).outcome == CheckOutcome::kFailed) return false;
  return true;
}

/// The filter that sines show in the runs that are sampled fast, with a margin.
DeclaredResponse filter_of(const CheckedCompensator& few, std::size_t threads) {
  const CheckContext context(few, threads);
  std::vector<SineResponse> responses;
  for (std::size_t k = 0; k < few.runs.size(); ++k)
    if (const double step = usual_step(*few.runs[k].recording);
        step > 0.0 && step <= kLongestFilterStep)
      for (const SineResponse& one : sine_responses(context, k))
        responses.push_back(one);
  DeclaredResponse filter;
  if (responses.empty()) return filter;
  double bandwidth = HUGE_VAL;
  for (const auto& [f, gain, delay] : responses)
    if (gain < kWhole)
      bandwidth =
          std::min(bandwidth, gain > std::sqrt(0.5)
                                  ? f / std::sqrt(1.0 / (gain * gain) - 1.0)
                                  : 0.5 * f);
  if (std::isfinite(bandwidth))
    filter.bandwidth = std::max(1.0, (1.0 - kMargin) * bandwidth);
  double delay = 0.0;
  for (const SineResponse& one : responses)
    if (one.frequency <= filter.bandwidth.value_or(one.frequency))
      delay = std::max(delay, one.delay - filter.most_delay(one.frequency));
  if (delay > kLeastDelay) filter.delay = (1.0 + kMargin) * delay;
  return filter;
}

}  // namespace

std::optional<DeclaredResponse> possible_declaration(
    const CheckContext& context) {
  CheckedCompensator few = few_runs(context);
  const double step = context.coarsest_step();
  const double resolution =
      step > kUndeclaredResolution && step <= 1.0 ? 1.001 * step : 0.0;
  const auto explains = [&](const DeclaredResponse& declared) {
    return passes(few, declared, context.threads);
  };
  if (resolution > 0.0 && explains({.resolution = resolution}))
    return DeclaredResponse{.resolution = resolution};
  DeclaredResponse filter = filter_of(few, context.threads);
  filter.resolution = resolution;
  if (filter.filters() && filter.delay <= 0.5 && explains(filter))
    return filter;
  // What happens after a power-on a run shows that lasts longer.
  std::erase_if(few.runs, [](const CheckedRun& run) {
    return run.recording->time.back() - run.recording->time.front() <
           4.0 * kLongestAfterPowerOn;
  });
  if (few.runs.empty() || explains({.resolution = resolution}))
    return std::nullopt;
  for (const auto member : {&DeclaredResponse::ready_after,
                            &DeclaredResponse::zeroes_at_power_on}) {
    std::optional<DeclaredResponse> found;
    for (const double seconds :
         {kLongestAfterPowerOn, 30.0, 20.0, 10.0, 5.0, 2.0, 1.0}) {
      DeclaredResponse declared{.resolution = resolution};
      declared.*member = seconds;
      if (!explains(declared)) break;
      found = declared;
    }
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace beamgyro::internal
