// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "validation/metrics/metric.h"
#include "validation/metrics/sigma_evidence.h"

namespace beamgyro::internal {

/// Probabilities of the intervals whose coverage is counted.
inline constexpr std::array<double, 3> kCoverageLevels = {0.5, 0.9, 0.95};

constexpr std::size_t kPitBins = 10;

/// Returns the share of the groups whose error lies within the central interval
/// of probability `level` of a normal distribution with the stated sigma: |z|
/// <= z_level. A group counts by the share of its errors that do. The interval
/// is of Clopper and Pearson for the effective number of groups n of Korn and
/// Graubard (1998):
///
///   p = sum x_c / sum m_c,   v = C/(C - 1) sum (x_c - p m_c)^2 / (sum m_c)^2
///   n = p (1 - p) / v, within 1 ... sum m_c,
///
/// for C clusters c of m_c groups, x_c of which are covered; n = C where v is
/// 0. Returns nothing without groups.
std::optional<Estimate> coverage(std::span<const ErrorGroup> groups,
                                 double level);

/// Distribution of u = Phi(z), the probability integral transform, which is
/// uniform on 0 ... 1 for a sigma that is right. Each group has the weight 1.
struct PitReport {
  std::array<double, kPitBins> histogram;  // [-], shares; their sum is 1
  double distance;                         // max |F(u) - u|, Kolmogorov
  double p_value;                          // of it, for that many clusters
};
std::optional<PitReport> pit_report(std::span<const ErrorGroup> groups);

/// Returns the mean of nu^2 / S over all innovations. The interval is that of a
/// ratio of sums over clusters, with Student's t, where there are
/// kLeastFilterClusters of them; otherwise chi-squared, of as many degrees of
/// freedom as innovations. Returns nothing without innovations.
constexpr std::size_t kLeastFilterClusters = 10;
std::optional<Estimate> mean_normalised(std::span<const FilterRun> runs);

/// How well a sigma fits the errors, of soaks or of ramps.
struct SigmaFit {
  std::size_t groups = 0, clusters = 0;
  std::array<std::optional<Estimate>, kCoverageLevels.size()> coverage = {};
  std::optional<PitReport> pit = {};
};

struct SigmaReport {
  SigmaFit soaks, ramps;
  std::size_t updates = 0;           // of the filter
  std::optional<Estimate> nis = {};  // mean_normalised()
};

SigmaReport sigma_report(const SigmaEvidence& evidence);

}  // namespace beamgyro::internal
