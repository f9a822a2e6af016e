// SPDX-License-Identifier: MIT
#include "compensation/scoring/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "random/random_stream.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::score_test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

/// Bias 1 deg/s in the first minute, 3 deg/s in the second and third.
const RecordedRun kSteps{.duration = 180.0,
                         .bias = [](double t) { return t < 60.0 ? 1.0 : 3.0; }};

AnsweredRun answered(const Recording& run, double share_removed) {
  auto answer = column_values(run, "rate");
  const auto& truth = column_values(run, "true_rate");
  for (std::size_t k = 0; k < answer.size(); ++k) {
    answer[k] -= share_removed * (answer[k] - truth[k]);
  }
  return {.name = "run", .recording = &run, .compensated = answer};
}

std::string message_of(const AnsweredRun& run) {
  return rejection([&] { score_run(run); });
}

TEST(Score, ShowsTheDriftThereWasAndWhatIsLeft) {
  const Recording run = kSteps.recording();
  const Score score = score_run(answered(run, 0.75)).score;
  EXPECT_NEAR(score.raw.mean, 7.0 / 3.0, 1e-14);
  EXPECT_NEAR(score.raw.variance, 8.0 / 9.0, 1e-14);
  EXPECT_NEAR(score.residual.variance, 8.0 / 9.0 / 16.0, 1e-14);
  EXPECT_NEAR(score.residual.peak_to_peak, 0.5, 1e-14);
  EXPECT_EQ(score.samples, 360U);
  EXPECT_FALSE(score.percent_of_cubic);
}

TEST(Score, PercentOfTheCubicIsTheRatioOfTheVariances) {
  const Recording run = kSteps.recording();
  AnsweredRun answer = answered(run, 0.75);
  answer.baseline = answered(run, 0.5).compensated;
  EXPECT_NEAR(*score_run(answer).score.percent_of_cubic, 25.0, 1e-10);
}

TEST(Score, ComparesWithAConstantAndACubicFittedToTheScoredBlocks) {
  RecordedRun swept{.duration = 3600.0, .step = 1.0};
  swept.temperature = [](double t) {
    return std::floor(t / 60.0);  // steady over each block
  };
  swept.bias = [T = swept.temperature](double t) {
    return 2.0 - 1e-2 * T(t) + 1e-5 * std::pow(T(t), 3);
  };
  const Recording run = swept.recording();
  const Score score = score_run(answered(run, 0.5)).score;
  EXPECT_NEAR(score.constant.rms, score.raw.sigma, 1e-12);
  EXPECT_GT(score.constant.rms, 0.1);
  EXPECT_LT(score.cubic->rms, 1e-12);

  const Recording steady = kSteps.recording();
  const Score flat = score_run(answered(steady, 0.5)).score;
  EXPECT_NEAR(flat.cubic->rms, flat.constant.rms, 1e-12);
  const Score both = score_together(
      {score_run(answered(run, 0.5)), score_run(answered(steady, 0.5))});
  EXPECT_GT(both.cubic->rms, 0.1);
  EXPECT_LT(both.cubic->rms, both.constant.rms);
}

TEST(Score, TogetherPoolsTheBlocksOfAllRuns) {
  const Recording first = kSteps.recording();
  RecordedRun other = kSteps;
  other.duration = 60.0;
  other.bias = [](double) { return -3.0; };
  const Recording second = other.recording();
  const Score all = score_together(
      {score_run(answered(first, 0.0)), score_run(answered(second, 0.0))});
  // Blocks 1, 3, 3, -3: mean 1, variance 6.
  EXPECT_EQ(all.residual.blocks, 4U);
  EXPECT_NEAR(all.residual.mean, 1.0, 1e-14);
  EXPECT_NEAR(all.residual.variance, 6.0, 1e-14);
  EXPECT_EQ(all.run, "overall");
}

TEST(Score, TogetherComparesWithTheCubicOnlyWhereEveryRunHasOne) {
  const Recording run = kSteps.recording();
  AnsweredRun with = answered(run, 0.75);
  with.baseline = with.compensated;
  const AnsweredRun without = answered(run, 0.75);
  EXPECT_FALSE(
      score_together({score_run(with), score_run(without)}).percent_of_cubic);
  EXPECT_TRUE(
      score_together({score_run(with), score_run(with)}).percent_of_cubic);
}

TEST(Score, TogetherKeepsTheWorstReplay) {
  const Recording run = kSteps.recording();
  const auto replayed = [&run](double retained) {
    AnsweredRun answer = answered(run, 0.5);
    answer.replayed = ReplayedScaleFactor{};
    answer.replayed->worst.large = ReplayedBlock{30.0, 25.0, 10.0, retained};
    return score_run(answer);
  };
  const auto worst = [&](const std::vector<double>& retained) {
    std::vector<ScoredRun> runs;
    for (const double one : retained) runs.push_back(replayed(one));
    return score_together(runs).replayed->worst.worse()->retained;
  };
  EXPECT_EQ(worst({1.0, 0.1, 1.0}), 0.1);
  EXPECT_EQ(worst({0.1, 3.0}), 0.1);  // what cancels before what amplifies
  EXPECT_EQ(worst({0.9, 1.2}), 1.2);
  EXPECT_TRUE(std::isnan(worst({kNan, 0.1})));
  EXPECT_TRUE(std::isnan(worst({0.1, kNan})));
}

TEST(Score, UnpoweredSamplesAreSkippedAndSaturatedOnesScored) {
  RecordedRun cycled = kSteps;
  cycled.powered = [](double t) { return t >= 60.0; };
  Recording run = cycled.recording();
  run.status[200] |= kOutputSaturated;
  const Score score = score_run(answered(run, 0.0)).score;
  EXPECT_EQ(score.samples, 240U);
  EXPECT_EQ(score.saturated, 1U);
  EXPECT_EQ(score.not_finite, 0U);
  EXPECT_EQ(score.residual.blocks, 2U);
  EXPECT_NEAR(score.residual.mean, 3.0, 1e-14);
}

TEST(Score, AnAnswerThatIsNotFiniteIsCountedAndLeavesNoScore) {
  const Recording run = kSteps.recording();
  AnsweredRun answer = answered(run, 0.75);
  answer.compensated[100] = kNan;
  const Score score = score_run(answer).score;
  EXPECT_EQ(score.not_finite, 1U);
  EXPECT_TRUE(std::isnan(score.residual.rms));
  EXPECT_TRUE(std::isfinite(score.raw.rms));
}

TEST(Score, WhiteNoiseIsKeptByABiasAndLostByANetworkThatEatsIt) {
  RandomStream stream(3, 0, 0, RandomPurpose{0});
  std::vector<double> noise(3600);
  stream.fill_normal(noise);
  const RecordedRun noisy{
      .duration = 360.0, .step = 0.1, .bias = [&noise](double t) {
        return 0.03 * noise[static_cast<std::size_t>(std::lround(10.0 * t))];
      }};
  const Recording run = noisy.recording();
  EXPECT_NEAR(*white_noise_ratio(answered(run, 0.0)), 1.0, 1e-12);
  EXPECT_NEAR(*white_noise_ratio(answered(run, 0.9)), 0.1, 1e-12);

  const Recording smooth = kSteps.recording();
  EXPECT_FALSE(white_noise_ratio(answered(smooth, 0.5)));
}

TEST(Score, RefusesARunItCannotScoreAndSaysWhich) {
  const Recording whole = kSteps.recording();
  AnsweredRun short_answer = answered(whole, 0.5);
  short_answer.compensated.pop_back();
  EXPECT_NE(message_of(short_answer).find("359 answers to 360 samples"),
            std::string::npos);

  Recording no_truth = whole;
  no_truth.columns.pop_back();
  AnsweredRun run{.name = "hot.h5",
                  .recording = &no_truth,
                  .compensated = short_answer.compensated};
  EXPECT_EQ(message_of(run),
            "run hot.h5: no column 'true_rate', which a score needs");

  Recording holed = whole;
  holed.columns[1].values[10] = kNan;
  run.recording = &holed;
  EXPECT_NE(message_of(run).find("rate is nan at 5 s"), std::string::npos);

  RecordedRun off = kSteps;
  off.powered = [](double) { return false; };
  const Recording dark = off.recording();
  EXPECT_NE(message_of(answered(dark, 0.5)).find("never powered"),
            std::string::npos);
}

}  // namespace
}  // namespace beamgyro::internal::score_test
