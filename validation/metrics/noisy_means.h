// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "validation/metrics/metric.h"
#include "validation/metrics/rate_noise_model.h"

namespace beamgyro::internal {

/// Means over segments of several runs, one after the other, with their noise.
struct NoisyMeans {
  std::vector<double> values;  // [deg/s]
  std::vector<Segment> segments;
  std::vector<SegmentNoise> noise;  // of each run
  std::vector<std::size_t> sizes;   // segments of each run

  /// Adds segments of a run: means of its residual, or of `signal`, with the
  /// noise seen in the residual.
  void add(const EvidenceRun& run, std::span<const SampleRange> ranges,
           std::span<const double> signal = {});

  std::vector<double> drawn_noise(std::uint32_t draw) const;  // [deg/s]
  bool without_noise() const;
};

/// Draws of the noise of means [deg/s], each of all of them.
using Draws = std::vector<std::vector<double>>;

/// Returns 300 draws of the noise of the means. Draws of the same noise are the
/// same; the last few are kept for all threads. Thread-safe.
std::shared_ptr<const Draws> draws_of(const NoisyMeans& means);

/// Returns whether a mean is not a number, which a largest value passes over.
bool lacks_answers(const NoisyMeans& means);

/// A figure computed from the means.
using Statistic = std::function<double(std::span<const double> means)>;

/// What the figure would be without the noise, roughly: the means themselves,
/// or drawn together towards zero or towards their mean, by the share of their
/// variance that is noise.
enum class Shrinkage { kNone, kToZero, kToMean };

/// How noise enlarges a figure.
enum class Growth {
  kSmooth,  // its error is added to it
  // The largest of many: it grows most by the first noise, which chooses the
  // extreme, and less by what is added to that.
  kExtreme,
};

/// Returns a figure of the means and the 95 % interval of what it would be
/// without the noise. The error of the figure is drawn: noise is added to the
/// shrunken means, and e is by how much that changes the figure.
/// The interval is
///
///   value - mean(e) -+ 1.96 sigma(e),
///
/// widened to contain the value, and cut off below `least`.
/// - The largest of several is never less than the one that is largest without
///   noise, which may be larger than the value by its own noise alone: the
///   upper end is at least value + 1.96 sigma of that, with all others as they
///   are.
/// - For an extreme figure the lower end is value - 1/(sqrt(2) - 1) mean(e) -
///   1.96 sigma(e): as much as the first noise adds where all means are equal.
/// The interval has no width if there is no noise.
Estimate estimate_beneath_noise(const NoisyMeans& means,
                                const Statistic& statistic, Shrinkage shrinkage,
                                double least = -HUGE_VAL,
                                Growth growth = Growth::kSmooth);

/// Returns estimate_beneath_noise() of the largest mean less the least.
Estimate estimate_of_range(const NoisyMeans& means, const Statistic& range);

/// As estimate_beneath_noise(), for the root of a quadratic form of the means,
/// to whose square noise adds its own and twice its product with the drift. The
/// drift is taken for t times the means: the lower end is the figure of that t
/// for which the square that was seen is the 0.975 quantile of the squares with
/// drawn noise, by their mean, sigma and skewness. The upper end is by the
/// 0.025 quantile, for a drift like the means and one standard deviation of the
/// noise that has most in common with them: noise that took away from the drift
/// also hides what it has in common.
Estimate estimate_of_root(const NoisyMeans& means, const Statistic& root);

/// Any of these for one kind of figure.
using Estimator = Estimate (*)(const NoisyMeans& means,
                               const Statistic& statistic);

/// Returns what the rms of the means without noise is at least, by what is left
/// of them when the mean over each window of `window` [s] of one power-on is
/// taken off. That cannot enlarge an rms, about zero or about the mean, but
/// takes off the turn-on offset and most of the slow noise. By a normal
/// quantile of 0.995, so that several windows can be asked.
double least_rms_within(const NoisyMeans& means, double window);

/// Returns the rms of what is left of the means within such windows, which
/// least_rms_within() does not exceed.
double rms_within(const NoisyMeans& means, double window);

/// As estimate_beneath_noise(), for a figure that measures the noise itself, so
/// that its truth is the root of the mean square over many draws; e are
/// logarithms of ratios.
Estimate estimate_of_noise(const NoisyMeans& means, const Statistic& statistic);

}  // namespace beamgyro::internal
