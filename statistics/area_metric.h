// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

// How far two distributions of a figure are apart, in the unit of the figure.
// docs/reference/curves.md says how to read it. Values are finite.
namespace beamgyro::internal {

/// Returns the area between the distribution functions of two samples, of one
/// value or more each: the integral of |F(x) - G(x)| over x. It is the integral
/// of |F^-1(p) - G^-1(p)| over p in (0, 1), too.
double area_metric(std::span<const double> one, std::span<const double> other);

/// A distribution of which some quantiles are known.
struct TabulatedQuantiles {
  std::span<const double> shares;  // two or more, increasing, in [0, 1]
  std::span<const double> values;  // as many, not falling
};

/// Returns the mean of |Q(p) - q(p)| over the tabulated shares, first to last:
/// Q is the quantile of the sample, on straight lines between sorted values
/// (percentile()), q that of the table, on straight lines between its entries.
/// What lies beyond the table does not count.
double area_metric(std::span<const double> sample,
                   const TabulatedQuantiles& table);

/// The area metric between two random halves of one sample: by how much two
/// samples of this size differ when nothing is different.
struct HalfSplit {
  double median, p95;
};

/// Splits `sample`, of two values or more, `draws` times into n/2 and n - n/2
/// values without replacement. Stream: seed, number of the draw, 0,
/// kHalfSplitStream.
HalfSplit half_split(std::span<const double> sample, std::size_t draws,
                     std::uint64_t seed);

}  // namespace beamgyro::internal
