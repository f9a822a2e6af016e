// SPDX-License-Identifier: MIT
#include "validation/metrics/sigma_report.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace beamgyro::internal {
namespace {

// A sum over a cluster, and the number of what it is over.
struct ClusterSum {
  double sum = 0.0, count = 0.0;
};

// A ratio of sums over clusters with the variance of its linear expansion.
struct ClusterRatio {
  double value, variance;
  std::size_t clusters;
  double count;
};

ClusterRatio ratio_of(const std::map<std::size_t, ClusterSum>& clusters) {
  ClusterSum all;
  for (const auto& [cluster, part] : clusters) {
    all.sum += part.sum;
    all.count += part.count;
  }
  const double ratio = all.sum / all.count;
  double squares = 0.0;
  for (const auto& [cluster, part] : clusters)
    squares += std::pow(part.sum - ratio * part.count, 2);
  const auto n = static_cast<double>(clusters.size());
  return {ratio,
          n > 1.0 ? n / (n - 1.0) * squares / (all.count * all.count) : 0.0,
          clusters.size(), all.count};
}

double covered_share(const ErrorGroup& group, double limit) {
  const auto within = std::ranges::count_if(
      group.z, [limit](double z) { return std::abs(z) <= limit; });
  return static_cast<double>(within) / static_cast<double>(group.z.size());
}

// Kolmogorov's distribution with the correction of Stephens (1970).
double kolmogorov_p_value(double distance, double n) {
  const double x = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k)
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return x < 0.2 ? 1.0 : std::clamp(sum, 0.0, 1.0);  // 1 - 1e-12 at 0.2
}

std::size_t clusters_of(std::span<const ErrorGroup> groups) {
  std::set<std::size_t> seen;
  for (const ErrorGroup& group : groups) seen.insert(group.cluster);
  return seen.size();
}

SigmaFit fit_of(std::span<const ErrorGroup> groups) {
  SigmaFit fit{.groups = groups.size(), .clusters = clusters_of(groups)};
  for (std::size_t k = 0; k < kCoverageLevels.size(); ++k)
    fit.coverage[k] = coverage(groups, kCoverageLevels[k]);
  fit.pit = pit_report(groups);
  return fit;
}

}  // namespace

std::optional<Estimate> coverage(std::span<const ErrorGroup> groups,
                                 double level) {
  if (groups.empty()) return std::nullopt;
  const double limit =
      quantile(boost::math::normal_distribution<double>(), 0.5 + 0.5 * level);
  std::map<std::size_t, ClusterSum> clusters;
  for (const ErrorGroup& group : groups) {
    ClusterSum& sum = clusters[group.cluster];
    sum.sum += covered_share(group, limit);
    sum.count += 1.0;
  }
  const ClusterRatio p = ratio_of(clusters);
  const double trials =
      p.variance > 0.0
          ? std::clamp(p.value * (1.0 - p.value) / p.variance, 1.0, p.count)
          : static_cast<double>(p.clusters);
  const double share = std::clamp(p.value, 0.0, 1.0);
  return Estimate{share, clopper_pearson(share * trials, trials)};
}

std::optional<PitReport> pit_report(std::span<const ErrorGroup> groups) {
  if (groups.empty()) return std::nullopt;
  const boost::math::normal_distribution<double> normal;
  const double weight = 1.0 / static_cast<double>(groups.size());
  std::vector<std::pair<double, double>> weighted;  // u and its weight
  PitReport report{{}, 0.0, 1.0};
  for (const ErrorGroup& group : groups)
    for (const double z : group.z) {
      const double u = cdf(normal, z);
      const double share = weight / static_cast<double>(group.z.size());
      weighted.emplace_back(u, share);
      const auto bin = static_cast<std::size_t>(u * kPitBins);
      report.histogram[std::min(bin, kPitBins - 1)] += share;
    }
  std::ranges::sort(weighted);
  double below = 0.0;
  for (const auto& [u, share] : weighted) {
    report.distance = std::max(report.distance, std::abs(below - u));
    below += share;
    report.distance = std::max(report.distance, std::abs(below - u));
  }
  report.p_value = kolmogorov_p_value(report.distance,
                                      static_cast<double>(clusters_of(groups)));
  return report;
}

std::optional<Estimate> mean_normalised(std::span<const FilterRun> runs) {
  std::map<std::size_t, ClusterSum> clusters;
  for (const FilterRun& run : runs) {
    ClusterSum& sum = clusters[run.cluster];
    for (const double value : run.normalised) sum.sum += value;
    sum.count += static_cast<double>(run.normalised.size());
  }
  if (clusters.empty()) return std::nullopt;
  const ClusterRatio mean = ratio_of(clusters);
  if (mean.clusters >= kLeastFilterClusters) {
    const double half =
        student_half_width(static_cast<double>(mean.clusters) - 1.0) *
        std::sqrt(mean.variance);
    return Estimate{mean.value, Interval{std::max(mean.value - half, 0.0),
                                         mean.value + half}};
  }
  const boost::math::chi_squared_distribution<double> chi(mean.count);
  const double sum = mean.value * mean.count;
  return Estimate{mean.value,
                  Interval{sum / quantile(complement(chi, kIntervalTail)),
                           sum / quantile(chi, kIntervalTail)}};
}

SigmaReport sigma_report(const SigmaEvidence& evidence) {
  SigmaReport report{.soaks = fit_of(evidence.soaks),
                     .ramps = fit_of(evidence.ramps)};
  for (const FilterRun& run : evidence.filter)
    report.updates += run.normalised.size();
  report.nis = mean_normalised(evidence.filter);
  return report;
}

}  // namespace beamgyro::internal
