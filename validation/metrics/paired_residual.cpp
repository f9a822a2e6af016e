// SPDX-License-Identifier: MIT
#include "validation/metrics/paired_residual.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/residual_scores.h"
#include "statistics/intervals.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kClustersOfRun = 8;

double rms_of_drift(const std::vector<double>& values) {
  return std::sqrt(
      std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
      static_cast<double>(values.size()));
}

}  // namespace

LeftDrift left_drift(const Evidence& evidence) {
  std::vector<const EvidenceRun*> runs = runs_for(evidence, quiet_purposes());
  if (runs.empty())
    for (const EvidenceRun& run : evidence.runs) runs.push_back(&run);
  LeftDrift left;
  std::size_t first = 0;  // cluster of the run
  for (const EvidenceRun* run : runs) {
    const auto& truth = column_values(*run->recording, "true_rate");
    const std::vector<double> means =
        block_residuals(score_blocks(*run->recording), run->rate, truth);
    const std::size_t clusters = std::min(kClustersOfRun, means.size());
    for (std::size_t k = 0; k < means.size(); ++k) {
      left.means.push_back(means[k]);
      left.clusters.push_back(first + k * clusters / means.size());
    }
    first += clusters;
  }
  return left;
}

LeftDrift without_mean(LeftDrift drift) {
  if (drift.means.empty()) return drift;
  const double mean = mean_of(drift.means);
  for (double& value : drift.means) value -= mean;
  return drift;
}

std::optional<PairedResidual> paired_residual(const LeftDrift& drift,
                                              const LeftDrift& other) {
  const std::size_t count = drift.means.size();
  if (count == 0) return std::nullopt;
  PairedResidual found{rms_of_drift(drift.means), rms_of_drift(other.means)};
  if (!std::isfinite(found.rms) || !std::isfinite(found.other_rms))
    return std::nullopt;
  std::vector<double> own(drift.clusters.back() + 1, 0.0), others = own;
  for (std::size_t k = 0; k < count; ++k) {
    own[drift.clusters[k]] += drift.means[k] * drift.means[k];
    others[drift.clusters[k]] += other.means[k] * other.means[k];
  }
  const double sum = std::accumulate(own.begin(), own.end(), 0.0);
  const double other_sum = std::accumulate(others.begin(), others.end(), 0.0);
  if (!(sum > 0.0) || !(other_sum > 0.0)) {
    found.gain = other_sum - sum;
    return found;
  }
  found.gain = std::log(other_sum / sum);
  const auto clusters = static_cast<double>(own.size());
  if (own.size() < 2) {
    found.half_width = HUGE_VAL;
    return found;
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k)
    squares += std::pow(own[k] / sum - others[k] / other_sum, 2);
  const double error = std::sqrt(squares * clusters / (clusters - 1.0));
  found.half_width = student_half_width(clusters - 1.0) * error;
  return found;
}

}  // namespace beamgyro::internal
