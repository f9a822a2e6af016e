// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace beamgyro {

/// What one number of a unit or a run is drawn from.
struct Distribution {
  enum class Kind { kNormal, kUniform, kLognormal, kDiscrete };

  Kind kind = Kind::kUniform;
  double centre = 0;  // mean; of a lognormal one the median
  double sigma = 0;   // of the value, or of its logarithm
  // Ends of kUniform; where the others are cut off.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  // kDiscrete: probability of this choice and those before it; the last is 1.
  std::vector<double> cumulative;
};

/// A choice among as many as there are weights, by weight; at least one weight
/// is above 0 and none below. One of weight 0 is never chosen.
Distribution discrete(const std::vector<double>& weights);

/// Value with the distribution function `u` in (0, 1). A distribution that is
/// cut off is the one under the condition that the value lies inside. Of
/// kDiscrete: the index of the choice.
double quantile(const Distribution& distribution, double u);

/// Share of the distribution between its ends `low` and `high`; 1 of kUniform
/// and kDiscrete.
double share_inside(const Distribution& distribution);

/// Distribution function of the standard normal one.
double normal_cumulative(double z);

}  // namespace beamgyro
