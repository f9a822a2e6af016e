// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
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

/// Returns 300 draws of the noise of the means [deg/s], each of all of them.
/// Draws of the same noise are the same. They are valid until the thread asks
/// for those of other noise.
const std::vector<std::vector<double>>& draws_of(const NoisyMeans& means);

/// Returns whether a mean is not a number, which a largest value passes over.
bool lacks_answers(const NoisyMeans& means);

/// A figure computed from the means.
using Statistic = std::function<double(std::span<const double> means)>;

/// What the figure would be without the noise, roughly: the means themselves,
/// or drawn together towards zero, towards their mean, or towards the mean
/// since their power-on, by the share of their variance that is noise.
enum class Shrinkage { kNone, kToZero, kToMean, kToPowerOn };

/// How noise enlarges a figure.
enum class Growth {
  kSmooth,  // its error is added to it
  kSquare,  // a root of a mean square: the error is added to its square
  // The largest of many: it grows most by the first noise, which chooses the
  // extreme, and less by what is added to that.
  kExtreme,
};

/// Returns a figure of the means and the 95 % interval of what it would be
/// without the noise. The error of the figure is drawn: noise is added to the
/// shrunken means, and e is by how much that changes the figure, or its square.
/// The interval is
///
///   value - mean(e) -+ 1.96 sigma(e),
///
/// widened to contain the value, and cut off below `least`.
/// - The largest of several is never less than the one that is largest without
///   noise, which may be larger than the value by its own noise alone: the
///   upper end is at least value + 1.96 sigma of that, with all others as they
///   are.
/// - For a mean square S the upper end is S - q, where q is the quantile of e
/// of
///   0.025, by its mean, sigma and skewness, about means that the noise has
///   lessened: the shrunken means (the means themselves where those are all
///   noise) and 1.96 standard deviations of the noise that enlarges their S
///   most. Noise that took away from the drift also took away from the sigma
///   of e, which would end the interval too low.
/// - For an extreme figure the lower end is value - 1/(sqrt(2) - 1) mean(e) -
///   1.96 sigma(e): as much as the first noise adds where all means are equal.
/// The interval has no width if there is no noise.
Estimate estimate_beneath_noise(const NoisyMeans& means,
                                const Statistic& statistic, Shrinkage shrinkage,
                                double least = -HUGE_VAL,
                                Growth growth = Growth::kSmooth);

/// Returns what the rms of the means without noise is at least, by what is left
/// of them when the mean over each window of `window` [s] of one power-on is
/// taken off. That cannot enlarge an rms, about zero or about the mean, but
/// takes off the turn-on offset and most of the slow noise. By a normal
/// quantile of 0.995, so that several windows can be asked.
double least_rms_within(const NoisyMeans& means, double window);

/// As estimate_beneath_noise(), for a figure that measures the noise itself, so
/// that its truth is the root of the mean square over many draws; e are
/// logarithms of ratios.
Estimate estimate_of_noise(const NoisyMeans& means, const Statistic& statistic);

}  // namespace beamgyro::internal
