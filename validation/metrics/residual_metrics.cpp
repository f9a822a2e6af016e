// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "compensation/scoring/residual_scores.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal {
namespace {

// Over a power-on as a whole, and over times in which slow noise moves less.
constexpr std::array kWindows = {HUGE_VAL, 14400.0, 3600.0, 1200.0};  // [s]

/// A score of the residual, and the least that it is as a multiple of the rms
/// within windows, which is at most the rms about the mean.
struct ResidualFigure {
  double ResidualScores::*score;
  double least_of_rms;
  Estimator estimate;
};

Estimate estimate_of_mean(const NoisyMeans& means, const Statistic& mean) {
  return estimate_beneath_noise(means, mean, Shrinkage::kNone);
}

Estimate estimate_of_size(const NoisyMeans& means, const Statistic& largest) {
  return estimate_beneath_noise(means, largest, Shrinkage::kToZero, 0.0,
                                Growth::kExtreme);
}

std::optional<Estimate> residual_figure(const Evidence& evidence,
                                        ResidualFigure figure) {
  NoisyMeans means;
  for (const EvidenceRun* run : runs_for(evidence, quiet_purposes()))
    means.add(*run, score_blocks(*run->recording));
  if (means.values.empty()) return std::nullopt;
  Estimate found = figure.estimate(means, [&](std::span<const double> r) {
    return residual_scores(r).*figure.score;
  });
  if (!(figure.least_of_rms > 0.0) || !std::isfinite(found.value)) return found;
  double& low = found.interval->low;
  for (const double window : kWindows)
    if (figure.least_of_rms * rms_within(means, window) > low)
      low = std::max(
          low, std::min(found.value,
                        figure.least_of_rms * least_rms_within(means, window)));
  return found;
}

std::optional<Estimate> normalised_residual(const Evidence& evidence) {
  NoisyMeans means;
  std::vector<double> sigma;  // [deg/s], of each mean
  for (const EvidenceRun* run : runs_for(evidence, quiet_purposes())) {
    const auto stated = stated_noise(*run->recording);
    const auto blocks = score_blocks(*run->recording);
    if (!stated || *stated == NoiseLevels{} || blocks.empty()) continue;
    const auto segments = segments_of(*run->recording, blocks);
    const auto values = means_over(segments, residual_of(*run));
    const SegmentNoise& noise = means.noise.emplace_back(*stated, segments);
    means.sizes.push_back(segments.size());
    means.values.insert(means.values.end(), values.begin(), values.end());
    sigma.insert(sigma.end(), noise.standard_deviations().begin(),
                 noise.standard_deviations().end());
  }
  if (means.values.empty()) return std::nullopt;
  return estimate_of_noise(means, [&](std::span<const double> r) {
    double sum = 0.0;
    for (std::size_t i = 0; i < r.size(); ++i)
      sum += r[i] * r[i] / (sigma[i] * sigma[i]);
    return std::sqrt(sum / static_cast<double>(r.size()));
  });
}

}  // namespace

std::vector<Metric> residual_metrics() {
  return {
      {"residual_mean_deg_per_s", "Mean residual", "deg/s", "",
       "Mean of the residual over blocks of 60 s: r_i is the mean of a "
       "block.",
       quiet_purposes(),
       given(residual_figure,
             ResidualFigure{&ResidualScores::mean, 0.0, estimate_of_mean})},
      {"residual_sigma_deg_per_s", "Standard deviation of the residual",
       "deg/s", "", "sqrt(sum (r_i - mean)^2 / n) over the blocks of 60 s.",
       quiet_purposes(),
       given(residual_figure,
             ResidualFigure{&ResidualScores::sigma, 1.0, estimate_of_root})},
      {"residual_rms_deg_per_s", "Rms of the residual", "deg/s", "",
       "sqrt(sum r_i^2 / n) over the blocks of 60 s.", quiet_purposes(),
       given(residual_figure,
             ResidualFigure{&ResidualScores::rms, 1.0, estimate_of_root})},
      {"residual_max_deg_per_s", "Largest residual", "deg/s", "",
       "max |r_i| over the blocks of 60 s.", quiet_purposes(),
       given(residual_figure,
             ResidualFigure{&ResidualScores::largest, 1.0, estimate_of_size})},
      {"residual_pp_deg_per_s", "Peak-to-peak residual", "deg/s", "",
       "max r_i - min r_i over the blocks of 60 s.", quiet_purposes(),
       given(residual_figure, ResidualFigure{&ResidualScores::peak_to_peak, 2.0,
                                             estimate_of_range})},
      {"normalised_residual", "Residual relative to its noise", "1", "",
       "sqrt(mean r_i^2 / s_i^2) over the blocks of 60 s: s_i is the "
       "standard deviation of a block's mean under the noise that the "
       "device states. 1: the noise explains what is left.",
       quiet_purposes(), normalised_residual},
  };
}

}  // namespace beamgyro::internal
