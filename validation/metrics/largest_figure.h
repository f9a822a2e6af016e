// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "validation/metrics/metric.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal {

/// Figures g_j computed from means, of which a metric states the largest.
using Candidates =
    std::function<std::vector<double>(std::span<const double> means)>;

/// Returns the largest |g_j| and the 95 % interval of what it would be without
/// the noise. Draws of the noise of a candidate are e_j = g_j(means + noise) -
/// g_j(means), their standard deviation is sigma_j; z = 1.96.
///
/// - The upper end is max_j (|g_j| + z sigma_j): whichever candidate is the
///   largest without noise lies below its own end, so below the highest of
///   them (an intersection-union test: Berger, Technometrics 24 (1982) 295).
/// - The lower end is the least L >= 0 with
///
///     P(max_j |c_j + e_j| >= max_j |g_j|) >= 0.025,
///
///   where c_j is g_j cut off at -L and L, and -L or L itself where |g_j| is
///   less than sigma_j short of it. So all candidates that may be as large as L
///   count with the noise that enlarges the largest of them, and no others
///   (inversion of a test of moment inequalities with generalised moment
///   selection: Andrews and Soares, Econometrica 78 (2010) 119).
///
/// The interval has no width if there is no noise.
Estimate estimate_of_largest(const NoisyMeans& means,
                             const Candidates& candidates);

/// The same for the candidate of the largest size with its sign. The interval
/// holds both signs where candidates of both may be the largest.
Estimate estimate_of_largest_signed(const NoisyMeans& means,
                                    const Candidates& candidates);

}  // namespace beamgyro::internal
