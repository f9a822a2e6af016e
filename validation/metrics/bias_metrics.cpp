// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "compensation/scoring/residual_scores.h"
#include "validation/metrics/evaluations.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal::evaluation {
namespace {

// Runs without a rate, or with one that is held for minutes.
const std::vector<const EvidenceRun*> quiet_runs(const Evidence& evidence) {
  using enum RunPurpose;
  return runs_for(evidence,
                  {kSoak, kRamp, kWarmUp, kPowerCycle, kRest, kConstantRate});
}

NoisyMeans block_means(const std::vector<const EvidenceRun*>& runs) {
  NoisyMeans means;
  for (const EvidenceRun* run : runs) {
    const std::vector<double> residual = residual_of(*run);
    means.add(*run->recording, score_blocks(*run->recording), residual,
              residual);
  }
  return means;
}

std::optional<Estimate> residual_figure(const Evidence& evidence,
                                        double ResidualScores::*figure,
                                        Shrinkage shrinkage, double least,
                                        Growth growth) {
  const NoisyMeans means = block_means(quiet_runs(evidence));
  if (means.values.empty()) return std::nullopt;
  return estimate_beneath_noise(
      means,
      [figure](std::span<const double> r) {
        return residual_scores(r).*figure;
      },
      shrinkage, least, growth);
}

}  // namespace

std::optional<Estimate> bias(const Evidence& evidence) {
  const NoisyMeans means = block_means(runs_for(evidence, {RunPurpose::kRest}));
  if (means.values.empty()) return std::nullopt;
  return estimate_beneath_noise(
      means, [](std::span<const double> r) { return residual_scores(r).mean; },
      Shrinkage::kNone);
}

std::optional<Estimate> residual_mean(const Evidence& evidence) {
  return residual_figure(evidence, &ResidualScores::mean, Shrinkage::kNone,
                         -HUGE_VAL, Growth::kSmooth);
}

std::optional<Estimate> residual_sigma(const Evidence& evidence) {
  return residual_figure(evidence, &ResidualScores::sigma, Shrinkage::kToMean,
                         0.0, Growth::kSquare);
}

std::optional<Estimate> residual_rms(const Evidence& evidence) {
  return residual_figure(evidence, &ResidualScores::rms, Shrinkage::kToZero,
                         0.0, Growth::kSquare);
}

std::optional<Estimate> residual_max(const Evidence& evidence) {
  return residual_figure(evidence, &ResidualScores::largest, Shrinkage::kToZero,
                         0.0, Growth::kExtreme);
}

std::optional<Estimate> residual_pp(const Evidence& evidence) {
  return residual_figure(evidence, &ResidualScores::peak_to_peak,
                         Shrinkage::kToMean, 0.0, Growth::kExtreme);
}

std::optional<Estimate> normalised_residual(const Evidence& evidence) {
  NoisyMeans means;
  std::vector<double> sigma;  // [deg/s], of each mean
  for (const EvidenceRun* run : quiet_runs(evidence)) {
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

std::optional<Estimate> in_run_stability(const Evidence& evidence) {
  constexpr double kBlock = 100.0;    // [s]
  constexpr double kHour = 3600.0;    // [s]
  constexpr std::size_t kLeast = 10;  // means
  NoisyMeans means;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRest})) {
    const Recording& recording = *run->recording;
    auto blocks = score_blocks(recording, kBlock);
    const double from = recording.time.back() - kHour - usual_step(recording);
    std::erase_if(blocks, [&](const SampleRange& block) {
      return recording.time[block.begin] <= from;
    });
    if (blocks.size() < kLeast) continue;
    const std::vector<double> residual = residual_of(*run);
    means.add(recording, blocks, residual, residual);
  }
  if (means.values.empty()) return std::nullopt;
  return estimate_of_noise(means, [&](std::span<const double> b) {
    double squares = 0.0;
    std::size_t first = 0;
    for (const std::size_t size : means.sizes) {
      squares += residual_scores(b.subspan(first, size)).variance *
                 static_cast<double>(size);
      first += size;
    }
    return std::sqrt(squares /
                     static_cast<double>(b.size() - means.sizes.size()));
  });
}

}  // namespace beamgyro::internal::evaluation
