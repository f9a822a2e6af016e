// SPDX-License-Identifier: MIT
// Checks of the temperatures that the compensator is given.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compensation/inputs/sample_ranges.h"
#include "validation/checks/check_context.h"

namespace beamgyro::internal {

CheckResult check_extrapolation(const CheckContext& context) {
  constexpr double kMostShare = 50.0;  // [%]
  if (context.checked.trained == nullptr)
    return not_tested("The compensator does not say what training saw.");
  const TemperatureRange& range = context.checked.trained->temperature_range;
  std::size_t clamped = 0;
  for (const CheckedRun& run : context.checked.runs)
    clamped += run.answer.clamped;
  const double share =
      100.0 * static_cast<double>(clamped) /
      static_cast<double>(std::max<std::size_t>(context.samples, 1));
  return {.outcome = passed_if(share <= kMostShare),
          .value = share,
          .limit = kMostShare,
          .words = fmt::format(
              "{:.3g} % of the samples lie outside {:g} to {:g} degC, the "
              "temperatures that training saw{}.",
              share, range.lowest, range.highest,
              share > kMostShare ? ", so these runs say little about it" : "")};
}

namespace {

constexpr double kLeastTemperatureSpread =
    2.0;                              // [K], less may be a constant temperature
constexpr double kStuckWithin = 0.1;  // [K], as by the noise of a converter
constexpr double kMostNoise = 0.5;    // [-], of the variance
constexpr double kClearDrift = 6.0;   // standard deviations

// Sums over the powered samples of all runs.
struct TemperatureSums {
  double count = 0.0, sum = 0.0, squares = 0.0;
  double steps = 0.0, step_squares = 0.0;
  double lowest = HUGE_VAL, highest = -HUGE_VAL;

  void add(const Recording& run, const std::vector<double>& temperature) {
    for (const SampleRange& stretch : powered_stretches(run))
      for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
        const double T = temperature[k];
        count += 1.0;
        sum += T;
        squares += T * T;
        lowest = std::min(lowest, T);
        highest = std::max(highest, T);
        if (k == stretch.begin) continue;
        steps += 1.0;
        step_squares += std::pow(T - temperature[k - 1], 2);
      }
  }

  double variance() const {
    return std::max(squares / count - std::pow(sum / count, 2), 0.0);
  }
  // [-]: 0 of a slow signal, 1 of white noise (von Neumann's ratio over 2).
  double noise_share() const {
    return steps > 0.0 && variance() > 0.0
               ? 0.5 * step_squares / steps / variance()
               : 0.0;
  }
};

// Whether the recorded drift changes by more than its noise. Slow means are
// compared with what neighbours differ by.
bool drifts(const Recording& run) {
  const auto& rate = column_values(run, "rate");
  const auto& truth = column_values(run, "true_rate");
  const std::vector<SampleRange> blocks = score_blocks(run);
  std::vector<double> means;
  for (const SampleRange& block : blocks) {
    double sum = 0.0;
    for (std::size_t k = block.begin; k < block.end; ++k)
      sum += rate[k] - truth[k];
    means.push_back(sum / static_cast<double>(block.size()));
  }
  if (means.size() < 10) return false;
  double differences = 0.0;
  for (std::size_t k = 1; k < means.size(); ++k)
    differences += std::pow(means[k] - means[k - 1], 2);
  const double noise =
      std::sqrt(0.5 * differences / static_cast<double>(means.size() - 1));
  const auto [low, high] = std::ranges::minmax(means);
  return high - low > kClearDrift * std::max(noise, 1e-3);
}

bool reads_temperature(const FittedCompensator* trained) {
  return trained == nullptr ||
         std::ranges::any_of(trained->inputs, [](const Input& input) {
           return input.column == "temperature";
         });
}

}  // namespace

CheckResult check_temperature_input(const CheckContext& context) {
  if (!reads_temperature(context.checked.trained))
    return not_tested("The compensator does not read the temperature.");
  TemperatureSums all;
  bool does_drift = false;
  for (const CheckedRun& run : context.checked.runs) {
    const Column* temperature = find_column(*run.recording, "temperature");
    if (temperature == nullptr)
      return not_tested(run.name + " has no temperature.");
    all.add(*run.recording, temperature->values);
    does_drift = does_drift || drifts(*run.recording);
  }
  if (all.count == 0.0) return not_tested("No sample is powered.");
  CheckResult result{.outcome = CheckOutcome::kPassed,
                     .value = all.noise_share(),
                     .limit = kMostNoise};
  const double spread = std::sqrt(all.variance());
  if (all.highest - all.lowest <= kStuckWithin && does_drift) {
    result.outcome = CheckOutcome::kFailed;
    result.value = 1.0;
    result.words = fmt::format(
        "The temperature is {:g} degC at every sample{} while the drift "
        "changes: its sensor is stuck, and the runs carry no information about "
        "it.",
        all.lowest,
        all.lowest == all.highest
            ? ""
            : fmt::format(", within {:.2g} K,", all.highest - all.lowest));
  } else if (spread > kLeastTemperatureSpread &&
             all.noise_share() > kMostNoise) {
    result.outcome = CheckOutcome::kFailed;
    result.words = fmt::format(
        "The temperature is noise: {:.3g} of its variance ({:.3g} K rms) is "
        "between neighbouring samples, so the runs carry no information about "
        "it.",
        all.noise_share(), spread);
  } else if (all.highest - all.lowest < kLeastTemperatureSpread) {
    return not_tested(fmt::format(
        "The temperatures of the runs differ by no more than {:.3g} K.",
        all.highest - all.lowest));
  } else {
    result.words = fmt::format(
        "The temperatures reach from {:.1f} to {:.1f} "
        "degC, and they are no noise.",
        all.lowest, all.highest);
  }
  return result;
}

}  // namespace beamgyro::internal
