// SPDX-License-Identifier: MIT
#include "sim/campaign/distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

// Ends in standard deviations.
struct Ends {
  double low, high;
};

Ends standardised(const Distribution& d) {
  if (d.kind == Distribution::Kind::kNormal)
    return {(d.low - d.centre) / d.sigma, (d.high - d.centre) / d.sigma};
  const auto z = [&](double end) {
    return end <= 0 ? -std::numeric_limits<double>::infinity()
                    : std::log(end / d.centre) / d.sigma;
  };
  return {z(d.low), z(d.high)};
}

// Both ends above the median are mirrored below it: an upper tail's
// probabilities are lost beside 1.
double truncated_normal(Ends ends, double u) {
  if (std::isinf(ends.low) && std::isinf(ends.high)) return normal_quantile(u);
  if (ends.low > 0) return -truncated_normal({-ends.high, -ends.low}, 1 - u);
  const double from = normal_cumulative(ends.low);
  const double to = normal_cumulative(ends.high);
  const double z = normal_quantile(std::clamp(
      from + u * (to - from), std::numeric_limits<double>::min(), 1 - 0x1p-53));
  return std::clamp(z, ends.low, ends.high);
}

double discrete_index(const std::vector<double>& cumulative, double u) {
  const auto choice = std::upper_bound(cumulative.begin(), cumulative.end(), u);
  return static_cast<double>(std::min<std::ptrdiff_t>(
      choice - cumulative.begin(),
      static_cast<std::ptrdiff_t>(cumulative.size()) - 1));
}

}  // namespace

Distribution discrete(const std::vector<double>& weights) {
  Distribution d;
  d.kind = Distribution::Kind::kDiscrete;
  double sum = 0;
  for (const double weight : weights) sum += weight;
  double before = 0;
  for (const double weight : weights)
    d.cumulative.push_back((before += weight) / sum);
  // Where rounding leaves the sum below 1, choices of weight 0 stay out.
  for (std::size_t i = weights.size(); i-- > 0;) {
    d.cumulative[i] = 1;
    if (weights[i] > 0) break;
  }
  return d;
}

std::vector<double> poisson_weights(double mean, int most) {
  std::vector<double> weights = {1};
  for (int k = 1; k <= most; ++k) weights.push_back(weights.back() * mean / k);
  return weights;
}

double normal_cumulative(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

double share_inside(const Distribution& d) {
  if (d.kind == Distribution::Kind::kUniform ||
      d.kind == Distribution::Kind::kDiscrete) {
    return 1;
  }
  Ends ends = standardised(d);
  if (ends.low > 0) ends = {-ends.high, -ends.low};
  return normal_cumulative(ends.high) - normal_cumulative(ends.low);
}

Distribution narrowed(const Distribution& d, double share) {
  using Kind = Distribution::Kind;
  Distribution narrow = d;
  narrow.sigma = share * d.sigma;
  if (d.kind == Kind::kNormal || d.kind == Kind::kUniform) {
    const double centre =
        d.kind == Kind::kNormal ? d.centre : 0.5 * (d.low + d.high);
    narrow.low = centre + share * (d.low - centre);
    narrow.high = centre + share * (d.high - centre);
  } else if (d.kind == Kind::kLognormal) {
    // A power of the ratio; a limit at or below 0 cuts nothing off.
    const auto nearer = [&](double end) {
      return end <= 0 ? end : d.centre * std::pow(end / d.centre, share);
    };
    narrow.low = nearer(d.low);
    narrow.high = nearer(d.high);
  }
  return narrow;
}

double quantile(const Distribution& d, double u) {
  if (d.either_sign) {
    Distribution magnitude = d;
    magnitude.either_sign = false;
    const double share = u < 0.5 ? 2 * u : 2 * u - 1;
    const double value = quantile(magnitude, std::max(share, 0x1p-54));
    return u < 0.5 ? -value : value;
  }
  switch (d.kind) {
    case Distribution::Kind::kNormal:
      return std::clamp(
          d.centre + d.sigma * truncated_normal(standardised(d), u), d.low,
          d.high);
    case Distribution::Kind::kUniform:
      return d.low + u * (d.high - d.low);
    case Distribution::Kind::kLognormal:
      return std::clamp(
          d.centre * std::exp(d.sigma * truncated_normal(standardised(d), u)),
          d.low, d.high);
    case Distribution::Kind::kDiscrete:
      return discrete_index(d.cumulative, u);
  }
  return 0;
}

}  // namespace beamgyro::internal
