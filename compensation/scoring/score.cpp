// SPDX-License-Identifier: MIT
#include "compensation/scoring/score.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/methods/fit.h"
#include "compensation/models/array_view.h"
#include "compensation/scoring/allan_deviation.h"

namespace beamgyro::internal {
namespace {

constexpr double kWhiteNoiseFall = 0.75;  // [-], deviation at 4 s over 1 s
constexpr double kShortestSeries = 10.0;  // [s]
constexpr double kStepTolerance = 1e-3;   // [-]

[[noreturn]] void fail_run(const AnsweredRun& run, const std::string& message) {
  throw std::invalid_argument(fmt::format("run {}: {}", run.name, message));
}

const std::vector<double>& powered_values(const AnsweredRun& run,
                                          const char* name) {
  const Column* column = find_column(*run.recording, name);
  if (column == nullptr) {
    fail_run(run, fmt::format("no column '{}', which a score needs", name));
  }
  for (const SampleRange& stretch : powered_stretches(*run.recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      if (!std::isfinite(column->values[k])) {
        fail_run(run,
                 fmt::format("{} is {} at {} s, must be finite while powered",
                             name, column->values[k], run.recording->time[k]));
      }
    }
  }
  return column->values;
}

void check_size(const AnsweredRun& run, const std::vector<double>& answer) {
  if (answer.size() != run.recording->time.size()) {
    fail_run(run, fmt::format("{} answers to {} samples, must be one each",
                              answer.size(), run.recording->time.size()));
  }
}

void count_samples(const AnsweredRun& run, Score& score) {
  const auto& status = run.recording->status;
  for (const SampleRange& stretch : powered_stretches(*run.recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      ++score.samples;
      score.not_finite += std::isfinite(run.compensated[k]) ? 0U : 1U;
      score.saturated += (status[k] & kOutputSaturated) != 0 ? 1U : 0U;
    }
  }
  if (score.samples == 0) {
    fail_run(run, "never powered, must have samples to score");
  }
}

ResidualScores scores_of(const Eigen::ArrayXd& residuals) {
  return residual_scores(
      {residuals.data(), static_cast<std::size_t>(residuals.size())});
}

/// What the cubic of `temperature` [degC] fitted to `raw` [deg/s] leaves of it.
Eigen::ArrayXd without_cubic(const Eigen::ArrayXd& raw,
                             const Eigen::ArrayXd& temperature) {
  TrainingRows rows;
  rows.temperature = temperature;
  rows.bias = raw;
  return raw - fit_baseline(rows).predict(temperature);
}

void fill_from_sums(const RunSums& sums, Score& score) {
  score.residual = residual_scores(sums.residual);
  score.raw = residual_scores(sums.raw);
  const Eigen::ArrayXd raw = array_view(sums.raw);
  score.constant = scores_of(raw - raw.mean());
  if (!sums.temperature.empty()) {
    score.cubic = scores_of(without_cubic(raw, array_view(sums.temperature)));
  }
  if (!sums.baseline.empty()) {
    score.baseline = residual_scores(sums.baseline);
    if (score.baseline->variance > 0.0) {
      score.percent_of_cubic =
          100.0 * score.residual.variance / score.baseline->variance;
    }
  }
  score.small_rates = scale_factor(sums.small_rates);
  score.every_rate = scale_factor(sums.every_rate);
}

/// Mean measured temperature [degC] of each block; empty when it is not
/// measured, or not finite somewhere.
std::vector<double> block_temperatures(const Recording& recording,
                                       const std::vector<SampleRange>& blocks) {
  const Column* temperature = find_column(recording, "temperature");
  std::vector<double> means;
  if (temperature == nullptr) {
    return means;
  }
  const std::vector<double> zero(recording.time.size(), 0.0);
  means = block_residuals(blocks, temperature->values, zero);
  if (!std::ranges::all_of(means, [](double T) { return std::isfinite(T); })) {
    means.clear();
  }
  return means;
}

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Keeps the worse of two: the larger value, NaN before any number.
template <typename Figure, typename Value>
void keep_worse(std::optional<Figure>& worst, const std::optional<Figure>& next,
                Value value) {
  if (next &&
      (!worst || std::isnan(value(*next)) || value(*next) > value(*worst))) {
    worst = next;
  }
}

}  // namespace

ScoredRun score_run(const AnsweredRun& run) {
  const Recording& recording = *run.recording;
  const auto& truth = powered_values(run, "true_rate");
  const auto& rate = powered_values(run, "rate");
  check_size(run, run.compensated);
  ScoredRun scored;
  Score& score = scored.score;
  RunSums& sums = scored.sums;
  score.run = run.name;
  count_samples(run, score);

  const auto blocks = score_blocks(recording);
  sums.residual = block_residuals(blocks, run.compensated, truth);
  sums.raw = block_residuals(blocks, rate, truth);
  sums.temperature = block_temperatures(recording, blocks);
  if (run.baseline) {
    check_size(run, *run.baseline);
    sums.baseline = block_residuals(blocks, *run.baseline, truth);
  }
  sums.small_rates = slope_sums(recording, run.compensated, kSmallRate);
  sums.every_rate = slope_sums(recording, run.compensated);
  fill_from_sums(sums, score);
  score.replayed = run.replayed;
  score.linearity = linearity(recording, run.compensated);
  score.raw_linearity = linearity(recording, rate);
  score.white_noise = white_noise_ratio(run);
  return scored;
}

Score score_together(const std::vector<ScoredRun>& runs) {
  Score all;
  RunSums sums;
  bool every_run_has_baseline = true;
  bool every_run_has_cubic = true;
  const auto nonlinearity = [](const Linearity& l) { return l.nonlinearity; };
  for (const ScoredRun& run : runs) {
    append(sums.residual, run.sums.residual);
    append(sums.raw, run.sums.raw);
    append(sums.baseline, run.sums.baseline);
    append(sums.temperature, run.sums.temperature);
    sums.small_rates += run.sums.small_rates;
    sums.every_rate += run.sums.every_rate;
    const Score& score = run.score;
    every_run_has_baseline =
        every_run_has_baseline && score.baseline.has_value();
    every_run_has_cubic = every_run_has_cubic && score.cubic.has_value();
    all.samples += score.samples;
    all.not_finite += score.not_finite;
    all.saturated += score.saturated;
    keep_worse(all.linearity, score.linearity, nonlinearity);
    keep_worse(all.raw_linearity, score.raw_linearity, nonlinearity);
    if (score.replayed) {
      all.replayed = all.replayed.value_or(*score.replayed);
      all.replayed->add(*score.replayed);
    }
    keep_worse(all.white_noise, score.white_noise,
               [](double ratio) { return std::abs(std::log(ratio)); });
  }
  if (!every_run_has_baseline) {
    sums.baseline.clear();
  }
  if (!every_run_has_cubic) {
    sums.temperature.clear();
  }
  fill_from_sums(sums, all);
  all.run = "overall";
  return all;
}

std::optional<double> white_noise_ratio(const AnsweredRun& run) {
  const auto& rate = column_values(*run.recording, "rate");
  const auto& truth = column_values(*run.recording, "true_rate");
  const SampleRange range =
      longest_gapless_range(*run.recording, run.compensated);
  std::vector<double> before;
  std::vector<double> after;
  for (std::size_t k = range.begin; k < range.end; ++k) {
    before.push_back(rate[k] - truth[k]);
    after.push_back(run.compensated[k] - truth[k]);
  }
  const double step = usual_step(*run.recording);
  const double samples = step > 0.0 ? std::round(1.0 / step) : 0.0;
  const bool whole = std::abs(samples * step - 1.0) < kStepTolerance;
  if (samples < 1.0 || !whole ||
      static_cast<double>(range.size()) < samples * kShortestSeries) {
    return std::nullopt;
  }
  const std::array taus{1.0, 4.0};
  const double interval = 1.0 / samples;
  const auto raw = oadev(before, interval, taus);
  if (!(raw[1].deviation <= kWhiteNoiseFall * raw[0].deviation)) {
    return std::nullopt;
  }
  return oadev(after, interval, taus)[0].deviation / raw[0].deviation;
}

}  // namespace beamgyro::internal
