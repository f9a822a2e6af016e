// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "compensation/scoring/deviation_kind.h"

namespace beamgyro::internal {

/// Of the differences of one kind at one tau, in units of rates.
struct RateDifferences {
  double squares = 0.0;
  double shares = 0.0;  // of the averages' white noise, see allan_curve()
  double count = 0.0;
  double complete = 0.0;  // how many there would be without gaps
  // Records that the differences come from: their samples, and how many.
  std::map<Eigen::Index, double> records = {};
};

/// The sums of a stretch of rates up to each place (times the interval these
/// are angles), of which all differences are made. The mean rate is taken off:
/// it cancels, and without it the sums stay small.
class AngleSums {
 public:
  /// NaN is a rate that is missing.
  AngleSums(const std::vector<double>& rates, double mean);

  /// Adds the differences of averages over m samples. Where samples are
  /// missing, adev, oadev, hdev and ohdev take averages of half of their
  /// samples and more, mdev and totdev the parts without a gap.
  void add(DeviationKind kind, Eigen::Index m, RateDifferences& total) const;

  /// Adds the squares of differences of samples `lag` apart.
  void add_lag(Eigen::Index lag, double& squares, double& pairs) const;

  /// Returns the neighbouring averages over m samples; NaN where fewer than
  /// half are there.
  std::vector<double> averages(Eigen::Index m) const;

 private:
  bool has(Eigen::Index k) const {
    return count_.size() == 0 || count_(k + 1) > count_(k);
  }
  double sample(Eigen::Index k) const { return sum_(k + 1) - sum_(k); }
  std::vector<std::pair<Eigen::Index, Eigen::Index>> whole_parts() const;

  void add_whole(int order, Eigen::Index m, Eigen::Index stride,
                 Eigen::Index starts, RateDifferences& total) const;
  void add_with_gaps(int order, Eigen::Index m, Eigen::Index stride,
                     Eigen::Index starts, RateDifferences& total) const;

  Eigen::ArrayXd sum_;
  Eigen::ArrayXd count_;  // of samples up to each place; empty without a gap
};

}  // namespace beamgyro::internal
