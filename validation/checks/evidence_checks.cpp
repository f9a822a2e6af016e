// SPDX-License-Identifier: MIT
// Checks of the answers against the true rate.
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/rate_departure.h"
#include "compensation/scoring/rate_injection.h"
#include "compensation/scoring/scale_factor.h"
#include "validation/checks/check_context.h"
#include "validation/checks/gain_judge.h"
#include "validation/checks/white_number.h"
#include "validation/metrics/allan_ratio.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kLeastTemperatures = 5;
constexpr std::size_t kLeastRates = 11;
constexpr double kSameTablePlace = 2.0;  // [K]

std::size_t different_values(std::vector<double> values, double same) {
  std::ranges::sort(values);
  std::size_t different = 0;
  double last = 0.0;
  for (const double value : values) {
    if (different > 0 && value - last < same) continue;
    last = value;
    ++different;
  }
  return different;
}

std::size_t held_rates(const Recording& run) {
  const auto& truth = column_values(run, "true_rate");
  std::vector<double> held;
  for (std::size_t k = 1; k < truth.size(); ++k)
    if (truth[k] == truth[k - 1] && (held.empty() || held.back() != truth[k]))
      held.push_back(truth[k]);
  return different_values(held, 1e-6);
}

}  // namespace

CheckResult check_true_rate(const CheckContext& context) {
  GainJudge judge = context.judge();
  std::vector<double> temperatures;
  std::size_t rates = 0;
  for (const std::size_t k : context.runs_of({RunPurpose::kRateTable})) {
    const Recording& run = *context.checked.runs[k].recording;
    const auto slopes = held_slopes(run, context.answers[k]);
    for (const auto& [plateau, uncertainty] : slopes) {
      judge.add(
          {context.checked.full_scale, plateau.compensated / plateau.raw,
           plateau.temperature, run.time.front(), context.checked.full_scale},
          plateau.raw / plateau.truth, uncertainty);
      temperatures.push_back(plateau.temperature);
    }
    if (!slopes.empty()) rates = std::max(rates, held_rates(run));
  }
  const std::size_t seen = different_values(temperatures, kSameTablePlace);
  if (judge.passed() && (seen < kLeastTemperatures || rates < kLeastRates))
    return not_tested(fmt::format(
        "{} rates at {} temperatures were recorded, must be {} at {} or more.",
        rates, seen, kLeastRates, kLeastTemperatures));
  CheckResult result = judge.result();
  if (judge.passed())
    result.words = fmt::format(
        "The compensator {} the scale factor on a rate table of {} rates at {} "
        "temperatures.",
        judge.corrects() ? "corrects" : "keeps", rates, seen);
  else
    result.words = fmt::format(
        "On a rate table the compensator changes the scale factor to {:.6g} of "
        "the recorded one at {:.1f} degC; expected {}.",
        judge.worst().gain, judge.worst().temperature, judge.expected());
  return result;
}

namespace {

constexpr double kAllanTolerance = 0.02;    // [-]
constexpr double kDeclaredNoiseLoss = 0.1;  // [-], of what a filter may take
constexpr double kLeastNoiseLeft = 0.5;     // [-], without a declared filter
constexpr std::size_t kLeastRestSeconds = 200;

bool is_at_rest(const Recording& run) {
  const auto& truth = column_values(run, "true_rate");
  return std::ranges::all_of(truth,
                             [&](double rate) { return rate == truth[0]; });
}

/// The run at rest whose ratio departs most from 1.
struct WorstAllan {
  AllanRatio found;
  std::size_t run;
};

std::optional<WorstAllan> worst_allan(const CheckContext& context) {
  std::optional<WorstAllan> worst;
  for (const std::size_t k : context.runs_of({RunPurpose::kRest})) {
    const Recording& run = *context.checked.runs[k].recording;
    if (!is_at_rest(run)) continue;
    const auto found =
        allan_ratio(run, context.answers[k], context.lag_in(run));
    if (found && found->seconds >= kLeastRestSeconds &&
        found->fall <= kWhiteNoiseFall &&
        (!worst ||
         std::abs(found->ratio - 1.0) > std::abs(worst->found.ratio - 1.0)))
      worst = WorstAllan{*found, k};
  }
  return worst;
}

/// Returns the share of a random rate as large as the noise and as fast, a new
/// one each second, that the answers show. Answers that may come late are
/// compared with the end of each second.
double noise_like_rate_kept(const CheckContext& context,
                            const WorstAllan& worst) {
  const Recording& run = *context.checked.runs[worst.run].recording;
  const auto& answers = context.answers[worst.run];
  const bool filters = context.declared().filters();
  const double size = std::sqrt(3.0) * worst.found.recorded;
  std::vector<double> added;
  for (const double t : run.time)
    added.push_back(size * white_number(static_cast<std::size_t>(
                               std::floor(t - run.time.front() + 1e-6))));
  const auto moved = context.with_rate(run, added);
  if (!moved) return 0.0;
  const std::vector<double> shown = context.altered(*moved);
  double product = 0.0, square = 0.0;
  for (std::size_t k = 0; k < added.size(); ++k) {
    if ((run.status[k] & kUnpowered) != 0) continue;
    if (filters && k + 1 < added.size() && added[k + 1] == added[k]) continue;
    product += added[k] * (shown[k] - answers[k]);
    square += added[k] * added[k];
  }
  return product / square;
}

/// The largest ratio that the rounding of the answers explains: of r it adds
/// r^2 / 12 to the variance of a sample, and of answers that hardly move twice
/// that.
double largest_by_rounding(const CheckContext& context,
                           const WorstAllan& worst) {
  const double step = usual_step(*context.checked.runs[worst.run].recording);
  const double added = std::pow(context.resolution(), 2) / 6.0 * step;
  return std::sqrt(1.0 + added / std::pow(worst.found.recorded, 2)) +
         kAllanTolerance;
}

CheckResult allan_result(const CheckContext& context, const WorstAllan& worst) {
  const auto within = [](double ratio) {
    return std::abs(ratio - 1.0) <= kAllanTolerance;
  };
  const double ratio = worst.found.ratio;
  const auto [low, high] = worst.found.interval;
  CheckResult result{.value = std::abs(ratio - 1.0), .limit = kAllanTolerance};
  const std::string found = fmt::format(
      "The Allan deviation at 1 s is {:.4f} ({:.4f} to {:.4f}) of the recorded "
      "one's",
      ratio, low, high);
  if (within(low) && within(high)) {
    result.outcome = CheckOutcome::kPassed;
    result.words = found + ": the compensator leaves the noise as it is.";
  } else if (low <= 1.0 + kAllanTolerance && high >= 1.0 - kAllanTolerance) {
    result.words =
        found +
        ". The runs at rest are too short, or their noise is too small, to "
        "tell it within 2 %.";
  } else if (ratio > 1.0) {
    const bool rounded = low <= largest_by_rounding(context, worst);
    result.outcome = rounded ? CheckOutcome::kPassed : CheckOutcome::kFailed;
    result.words = found + (rounded ? ": as much noise as their rounding adds."
                                    : ": the compensator adds noise.");
  } else if (const double kept = noise_like_rate_kept(context, worst);
             within(kept) || (context.declared().filters() &&
                              std::abs(kept - 1.0) <= kDeclaredNoiseLoss)) {
    const bool tells = high >= kLeastNoiseLeft || context.declared().filters();
    if (tells) result.outcome = CheckOutcome::kPassed;
    result.words =
        found + (tells ? ", and a rate as small and as fast as the noise comes "
                         "out whole."
                       : ": so much noise drops where answers are filtered, "
                         "and no filter is declared, so this does not tell.");
  } else {
    result.outcome = CheckOutcome::kFailed;
    result.words = found + ": noise that drops is rate that was eaten.";
  }
  return result;
}

}  // namespace

CheckResult check_allan_fingerprint(const CheckContext& context) {
  const auto worst = worst_allan(context);
  if (!worst)
    return not_tested(
        "No run at rest has noise and 200 s of samples, a whole number of them "
        "each second.");
  return allan_result(context, *worst);
}

namespace {

constexpr double kChance = 3.0;      // standard deviations
constexpr std::size_t kShifts = 64;  // of the true rate against the answers
constexpr double kLeastRateSpread = 0.1;  // [deg/s], rms

using RateSeries = Eigen::VectorXd;

/// The samples of a run that can be correlated.
struct MixedRun {
  std::vector<double> time;
  RateSeries truth, temperature;
  RateSeries kept,
      corrected;        // corrections: rate - answer, rate / s(T) - answer
  RateSeries left;      // answer - true rate
  RateSeries filtered;  // true rate - what a declared filter leaves of it
};

MixedRun mixed_run(const CheckContext& context, std::size_t number) {
  const Recording& run = *context.checked.runs[number].recording;
  const auto& rate = column_values(run, "rate");
  const auto& truth = column_values(run, "true_rate");
  const Column* temperature = find_column(run, "temperature");
  const std::ptrdiff_t lag = context.lag_in(run);
  const std::vector<double> after = context.declared().filtered(run, truth);
  std::vector<double> all[6];
  MixedRun mixed;
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    const std::ptrdiff_t later = static_cast<std::ptrdiff_t>(k) + lag;
    const auto at = static_cast<std::size_t>(later);
    if (later < 0 || at >= run.time.size() || run.status[k] != 0 ||
        run.status[at] != 0)
      continue;
    const double T = temperature ? temperature->values[k] : 0.0;
    const double s = context.scale_factor.empty() || !temperature
                         ? 1.0
                         : context.scale_factor.at(T);
    const double answer = context.answers[number][at];
    mixed.time.push_back(run.time[k]);
    all[0].push_back(truth[k]);
    all[1].push_back(T);
    all[2].push_back(rate[k] - answer);
    all[3].push_back(rate[k] / s - answer);
    all[4].push_back(answer - truth[k]);
    all[5].push_back(truth[k] - after[k]);
  }
  RateSeries* series[] = {&mixed.truth, &mixed.temperature,
                          &mixed.kept,  &mixed.corrected,
                          &mixed.left,  &mixed.filtered};
  for (std::size_t k = 0; k < 6; ++k)
    *series[k] = Eigen::Map<const RateSeries>(
        all[k].data(), static_cast<Eigen::Index>(all[k].size()));
  return mixed;
}

struct RateShare {
  double share = 0.0;   // [-], of the true rate in the correction
  double chance = 0.0;  // [-], kChance sigma of it when nothing is there
};

/// The share, and by chance that of the true rate turned round by parts of the
/// run.
RateShare rate_share(const RateSeries& rate, const RateSeries& correction) {
  const Eigen::Index n = rate.size();
  const double square = rate.squaredNorm();
  RateShare result{rate.dot(correction) / square};
  double squares = 0.0;
  for (std::size_t k = 1; k < kShifts; ++k) {
    const auto shift =
        static_cast<Eigen::Index>(k) * n / static_cast<Eigen::Index>(kShifts);
    const double product =
        rate.head(n - shift).dot(correction.tail(n - shift)) +
        rate.tail(shift).dot(correction.head(shift));
    squares += std::pow(product / square, 2);
  }
  result.chance = kChance * std::sqrt(squares / (kShifts - 1));
  return result;
}

}  // namespace

CheckResult check_rate_correlation(const CheckContext& context) {
  std::optional<CheckResult> worst;
  for (const std::size_t k : context.runs_of({RunPurpose::kRandomRate})) {
    const MixedRun run = mixed_run(context, k);
    if (run.truth.size() < static_cast<Eigen::Index>(10 * kShifts)) continue;
    const RateSeries rate = without_drift(run.truth, run.temperature, run.time);
    if (rate.norm() <
        kLeastRateSpread * std::sqrt(static_cast<double>(rate.size())))
      continue;
    const auto share_of = [&](const RateSeries& correction) {
      return rate_share(rate,
                        without_drift(correction, run.temperature, run.time));
    };
    // As far as a declared filter may take the rate away.
    const double allowed = context.declared().filters()
                               ? std::abs(share_of(run.filtered).share)
                               : 0.0;
    const auto found = [&](const RateSeries& correction, double tolerance) {
      const RateShare share = share_of(correction);
      const double limit = std::max(tolerance, share.chance) + allowed;
      return CheckResult{.outcome = passed_if(std::abs(share.share) <= limit),
                         .value = std::abs(share.share),
                         .limit = limit};
    };
    CheckResult result = found(run.kept, kGainTolerance);
    const double spread = context.scale_factor.empty()
                              ? 0.0
                              : context.scale_factor.largest_departure();
    if (!result.passed() && 0.5 * spread > kCorrectedTolerance)
      if (const auto corrected = found(run.corrected, kCorrectedTolerance);
          corrected.passed())
        result = corrected;
    // What the gyro made of the rate may be corrected, whatever it was.
    if (!result.passed())
      if (const auto left = found(run.left, kGainTolerance); left.passed())
        result = left;
    if (!worst || *result.value / *result.limit > *worst->value / *worst->limit)
      worst = result;
  }
  if (!worst)
    return not_tested("No run varies its true rate over 640 samples or more.");
  worst->words =
      worst->passed()
          ? "The correction does not depend on the true rate, or makes the "
            "answers follow it."
          : fmt::format(
                "The correction follows the true rate: {:.3g} of it is "
                "found there, by chance it would be below {:.3g}.",
                *worst->value, *worst->limit);
  return *worst;
}

}  // namespace beamgyro::internal
