// SPDX-License-Identifier: MIT
#include "validation/result/metric_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace beamgyro::internal {
namespace {

constexpr double kEqualWithin = 1e-9;  // [-], of a value

double part_above(const Estimate& estimate) {
  return estimate.interval ? estimate.interval->high - estimate.value : 0.0;
}

double part_below(const Estimate& estimate) {
  return estimate.interval ? estimate.value - estimate.interval->low : 0.0;
}

Change direction_of(const Metric& metric, double own, double other) {
  const double more = shortfall_of(metric, own) - shortfall_of(metric, other);
  return more > 0.0 ? Change::kWorse : Change::kBetter;
}

// The drift that both leave, block by block.
void pair(const PairedResidual& found, MetricChange& rms) {
  if (!std::isfinite(found.half_width)) return;
  const auto difference = [&](double gain) {
    return found.other_rms * (std::exp(-0.5 * gain) - 1.0);
  };
  rms.difference = {difference(found.gain),
                    Interval{difference(found.gain + found.half_width),
                             difference(found.gain - found.half_width)}};
  rms.change = std::abs(found.gain) <= found.half_width + kEqualWithin
                   ? Change::kSame
               : found.gain > 0.0 ? Change::kBetter
                                  : Change::kWorse;
}

std::string verdict_words(const std::string& name, Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return name + " passes";
    case Verdict::kFail:
      return name + " fails";
    case Verdict::kUndecided:
      break;
  }
  return name + " is undecided";
}

std::string sentence_of(const std::string& own, Verdict verdict,
                        const std::string& other, Verdict other_verdict,
                        const std::optional<PairedResidual>& residual) {
  std::string left;
  bool is_better = false, is_worse = false;
  if (residual) {
    left = fmt::format(
        "of the drift of the same runs {} leaves {:.3g} and {} {:.3g} deg/s "
        "rms",
        own, residual->rms, other, residual->other_rms);
    is_better = residual->is_better();
    is_worse = -residual->gain > residual->half_width + kEqualWithin;
    if (!is_better && !is_worse)
      left += ", a difference within its 95 % interval";
  }
  const std::string verdicts = verdict_words(own, verdict) + " and " +
                               verdict_words(other, other_verdict);
  if ((verdict == Verdict::kPass) != (other_verdict == Verdict::kPass)) {
    is_better = verdict == Verdict::kPass;
    is_worse = !is_better;
  }
  const std::string reasons =
      verdicts + (left.empty() ? "" : "; " + left) + ".";
  if (!is_better && !is_worse)
    return fmt::format("The runs do not tell which of {} and {} is better: {}",
                       own, other, reasons);
  return fmt::format("{} is better than {}: {}", is_better ? own : other,
                     is_better ? other : own, reasons);
}

}  // namespace

std::string_view change_name(Change change) {
  switch (change) {
    case Change::kSame:
      return "same";
    case Change::kBetter:
      return "better";
    case Change::kWorse:
      return "worse";
    case Change::kUnknown:
      break;
  }
  return "unknown";
}

MetricChange change_of(const Metric& metric, const Estimate& own,
                       const Estimate& other) {
  MetricChange found{&metric, own, other, {own.value - other.value}};
  const double difference = found.difference.value;
  if (own.interval || other.interval)
    found.difference.interval = {
        difference - std::hypot(part_below(own), part_above(other)),
        difference + std::hypot(part_above(own), part_below(other))};
  const auto& interval = found.difference.interval;
  const bool is_equal =
      std::abs(difference) <=
      kEqualWithin * std::max(std::abs(own.value), std::abs(other.value));
  const bool is_known = interval && !std::isnan(difference) &&
                        !std::isnan(interval->low) &&
                        !std::isnan(interval->high);
  if (!is_equal && !is_known)
    found.change = Change::kUnknown;
  else if (is_equal || (interval->low <= 0.0 && interval->high >= 0.0))
    found.change = Change::kSame;
  else
    found.change = direction_of(metric, own.value, other.value);
  return found;
}

SideBySide side_by_side(const JudgedBy& other,
                        const TestedCompensator& answering,
                        const std::string& name, const ValidationResult& own,
                        DeviceEvidence& found, std::size_t threads) {
  const LeftDrift drift = left_drift(found.after);
  std::vector<Answer> answers = found.answers;
  Evidence after = found.after;
  answer_again(found, answering, other.trained != nullptr, threads);
  ValidationResult result;
  judge(other, found, threads, result);
  SideBySide both{
      {name, "compensator",
       other.trained != nullptr ? other.trained->provenance.method : "",
       other.compensator.inputs()},
      result.verdict,
      result.words,
      ""};
  both.residual = paired_residual(drift, left_drift(found.after));
  found.answers = std::move(answers);
  found.after = std::move(after);
  for (const MetricResult& metric : own.metrics) {
    const auto same =
        std::ranges::find(result.metrics, metric.metric, &MetricResult::metric);
    if (same == result.metrics.end() || !metric.after || !same->after) continue;
    both.metrics.push_back(
        change_of(*metric.metric, *metric.after, *same->after));
    if (both.residual && metric.metric->name == "residual_rms_deg_per_s")
      pair(*both.residual, both.metrics.back());
  }
  both.sentence = sentence_of(own.compensator.name, own.verdict, name,
                              result.verdict, both.residual);
  both.limits = std::move(result.limits);
  both.checks = std::move(result.checks);
  return both;
}

}  // namespace beamgyro::internal
