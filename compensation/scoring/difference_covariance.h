// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace beamgyro::internal {

/// Differences Delta^order of angles `length` samples apart, one at each of
/// `starts` samples.
struct AngleDifferences {
  int order;
  double length;
  double starts;
};

/// With the covariances C of every difference of one kind and every one of the
/// other, and their mean over all pairs <>:
struct PairMeans {
  double covariance = 0.0;  // <C>
  double squares = 0.0;     // <C^2>
};

/// Returns the means over all pairs, of angles with the generalised
/// autocovariance r(t), t in samples: r is one whose differences are the
/// covariances of differences, |t| for a random walk. Lags beyond two lengths
/// after the last overlap do not count; between the lags where the filters
/// meet, C is taken at lags that grow by a quarter.
PairMeans pair_means(const std::function<double(double)>& r,
                     const AngleDifferences& first,
                     const AngleDifferences& second);

/// Returns the variance of one difference of angles with that r(t).
double variance_of_difference(const std::function<double(double)>& r,
                              const AngleDifferences& differences);

}  // namespace beamgyro::internal
