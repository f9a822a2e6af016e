// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

namespace beamgyro::internal {

/// The distribution of one number of a unit or a run.
struct Distribution {
  enum class Kind { kNormal, kUniform, kLognormal, kDiscrete };

  Kind kind = Kind::kUniform;
  double centre = 0;  // mean; of a lognormal one the median
  double sigma = 0;   // of the value, or of its logarithm
  // Ends of kUniform; limits at which the others are cut off.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  // The value gets either sign with equal probability, after it was drawn.
  bool either_sign = false;
  // kDiscrete: probability of this choice and of those before it. The last is
  // 1.
  std::vector<double> cumulative;
};

/// Returns the distribution of a choice by weight. At least one weight is above
/// 0 and none is below. A choice of weight 0 is never drawn.
Distribution discrete(const std::vector<double>& weights);

/// Returns the weights of the counts 0 .. `most` of a Poisson distribution, not
/// normalised.
std::vector<double> poisson_weights(double mean, int most);

/// Returns the value at which the distribution function is `u` in (0, 1); of
/// kDiscrete the index of the choice. A distribution that is cut off is the
/// conditional one, given that the value lies inside. With either sign, u below
/// 1/2 gives the negative values, and the magnitude grows with u on both sides.
double quantile(const Distribution& distribution, double u);

/// Returns the distribution of `share` > 0 of the width: every value that much
/// nearer to the centre, of kLognormal in its logarithm, so that limits move
/// inwards as well. The centre is the mean of kNormal, the median of kLognormal
/// and the middle of kUniform. Returns kDiscrete as it is.
Distribution narrowed(const Distribution& distribution, double share);

/// Returns the probability that the uncut distribution gives a value between
/// `low` and `high`; 1 for kUniform and kDiscrete.
double share_inside(const Distribution& distribution);

/// Returns the distribution function of the standard normal distribution.
double normal_cumulative(double z);

}  // namespace beamgyro::internal
