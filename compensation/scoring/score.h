// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compensation/scoring/linearity.h"
#include "compensation/scoring/replayed_scale_factor.h"
#include "compensation/scoring/residual_scores.h"
#include "compensation/scoring/scale_factor.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A run and the answers of a compensator to it.
struct AnsweredRun {
  std::string name;
  const Recording* recording = nullptr;           // not owned
  std::vector<double> compensated{};              // [deg/s], one per time
  std::optional<std::vector<double>> baseline{};  // [deg/s], the cubic's answer
  std::optional<ReplayedScaleFactor> replayed{};
};

/// Scores of one run, or of several together.
struct Score {
  std::string run;
  bool in_sample = false;      // training used the run
  std::size_t samples = 0;     // powered
  std::size_t not_finite = 0;  // of them without a finite answer
  std::size_t saturated = 0;   // of them with a saturated output
  ResidualScores residual;     // of the compensated rate
  ResidualScores raw;          // of the recorded one: the drift there was
  // Scores of the cubic that the compensator's file claims.
  std::optional<ResidualScores> baseline;
  // Scores of a constant and of a cubic of the temperature that are fitted to
  // the raw blocks of the scored runs. The cubic has a lower degree where the
  // blocks do not determine it.
  ResidualScores constant;
  std::optional<ResidualScores> cubic;
  std::optional<double> percent_of_cubic;  // [%], of baseline's variance
  std::optional<ScaleFactor> small_rates;  // |true_rate| <= kSmallRate
  std::optional<ScaleFactor> every_rate;
  std::optional<ReplayedScaleFactor> replayed;
  std::optional<Linearity> linearity;  // of the compensated rate
  std::optional<Linearity> raw_linearity;
  std::optional<double> white_noise;  // [-], white_noise_ratio()
};

/// Sums from which the scores of several runs together are computed.
struct RunSums {
  std::vector<double> residual;     // [deg/s], block means
  std::vector<double> raw;          // [deg/s]
  std::vector<double> baseline;     // [deg/s], empty without one
  std::vector<double> temperature;  // [degC], empty when not measured
  SlopeSums small_rates;
  SlopeSums every_rate;
};

struct ScoredRun {
  Score score;
  RunSums sums;
};

/// Scores a run. Every powered sample counts towards the residual, also
/// saturated ones, because the user gets that rate. Throws
/// std::invalid_argument naming the run for
/// - a column `rate` or `true_rate` that is missing, or not finite while
///   powered;
/// - answers with another number of samples than the run;
/// - a run that is never powered.
ScoredRun score_run(const AnsweredRun& run);

/// Scores several runs together: their blocks are pooled and their slope_sums()
/// added. Linearity, replays and white noise are those of the worst run. A
/// cubic is scored when every run has one.
Score score_together(const std::vector<ScoredRun>& runs);

/// Returns the Allan deviation at 1 s of the compensated residual divided by
/// that of the raw one, in the longest gapless stretch. A compensator that does
/// not see the rate cannot lower the white noise: a ratio well below 1 is the
/// sign of one that cancels the rate. A compensator with a ratio above 1 adds
/// noise. Returns nothing
/// - where the raw residual has no white noise at 1 s (its deviation at 4 s is
///   above 0.75 of that at 1 s; white noise has 0.5);
/// - where 1 s is no multiple of the step;
/// - for less than 10 s.
std::optional<double> white_noise_ratio(const AnsweredRun& run);

}  // namespace beamgyro::internal
