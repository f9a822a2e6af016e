// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compensation/linearity.h"
#include "compensation/replayed_scale_factor.h"
#include "compensation/residual_scores.h"
#include "compensation/scale_factor.h"
#include "dataset/recording.h"

namespace beamgyro {

/// A run and what a compensator answered to it.
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
  // Of the cubic that the compensator claims for its training.
  std::optional<ResidualScores> baseline;
  // Of a constant, and a cubic of the temperature, fitted to the raw blocks
  // that are scored; the cubic of lower degree where these do not determine it.
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

/// What scores of several runs together are made of.
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

/// Every powered sample counts towards the residual, saturated ones too: their
/// user gets that rate. Throws std::invalid_argument naming the run for a
/// missing column `rate` or `true_rate`, one that is not finite while powered,
/// an answer with another number of samples than the run, a run never powered.
ScoredRun score_run(const AnsweredRun& run);

/// Blocks of all runs pooled and slope_sums() added; of linearity, replays and
/// white noise the worst run. Cubics count when every run has one.
Score score_together(const std::vector<ScoredRun>& runs);

/// White noise kept: Allan deviation at 1 s of the compensated residual over
/// that of the raw one, in the longest gapless stretch. A compensator that does
/// not see the rate cannot lower it: well below 1 is the fingerprint of one
/// that cancels the rate, above 1 it adds noise of its own. Nothing where the
/// raw residual shows no white noise there (its deviation at 4 s is above 0.75
/// of that at 1 s; white noise has 0.5), where 1 s is no multiple of the step,
/// or for less than 10 s.
std::optional<double> white_noise_ratio(const AnsweredRun& run);

}  // namespace beamgyro
