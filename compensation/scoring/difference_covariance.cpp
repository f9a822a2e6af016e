// SPDX-License-Identifier: MIT
#include "compensation/scoring/difference_covariance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

namespace beamgyro::internal {
namespace {

constexpr double kDense = 4.0;    // lags on each side of a meeting, one by one
constexpr double kGrowth = 1.25;  // of their distance to it, further on
constexpr double kLastLengths = 2.0;

/// Coefficients of the difference of an order: 1, -2, 1.
std::vector<double> binomials(int order) {
  std::vector<double> all{1.0};
  for (int k = 1; k <= order; ++k)
    all.push_back(-all.back() * (order - k + 1) / k);
  return all;
}

/// C at a lag is the sum of coefficient r(lag + shift).
struct Shifted {
  double shift, coefficient;
};

std::vector<Shifted> shifted_terms(const AngleDifferences& first,
                                   const AngleDifferences& second) {
  const std::vector<double> a = binomials(first.order);
  const std::vector<double> b = binomials(second.order);
  std::map<double, double> terms;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      terms[static_cast<double>(j) * second.length -
            static_cast<double>(i) * first.length] += a[i] * b[j];
  std::vector<Shifted> all;
  for (const auto& [shift, coefficient] : terms)
    all.push_back({shift, coefficient});
  return all;
}

/// Lags from `low` to `high`, close together next to either.
void add_lags(double low, double high, std::vector<double>& lags) {
  const double half = 0.5 * (high - low);
  for (double step = 1.0; step <= half;
       step = step < kDense ? step + 1.0 : std::ceil(step * kGrowth)) {
    lags.push_back(low + step);
    lags.push_back(high - step);
  }
}

/// Whole lags in [low, high], close together at each of `meetings`.
std::vector<double> lags_at(std::vector<double> meetings, double low,
                            double high) {
  std::erase_if(meetings, [&](double lag) { return lag < low || lag > high; });
  meetings.push_back(low);
  meetings.push_back(high);
  std::ranges::sort(meetings);
  std::vector<double> lags = meetings;
  for (std::size_t k = 0; k + 1 < meetings.size(); ++k)
    add_lags(meetings[k], meetings[k + 1], lags);
  std::ranges::sort(lags);
  lags.erase(std::unique(lags.begin(), lags.end()), lags.end());
  return lags;
}

double covariance_at(const std::function<double(double)>& r,
                     const std::vector<Shifted>& terms, double lag) {
  double sum = 0.0;
  for (const auto& [shift, coefficient] : terms)
    sum += coefficient * r(lag + shift);
  return sum;
}

}  // namespace

PairMeans pair_means(const std::function<double(double)>& r,
                     const AngleDifferences& first,
                     const AngleDifferences& second) {
  const std::vector<Shifted> terms = shifted_terms(first, second);
  std::vector<double> meetings;
  for (const Shifted& term : terms) meetings.push_back(-term.shift);
  const double most = kLastLengths * std::max(first.length, second.length);
  const double low = std::max(1.0 - first.starts, meetings.back() - most);
  const double high = std::min(second.starts - 1.0, meetings.front() + most);
  const std::vector<double> lags = lags_at(meetings, low, high);
  PairMeans sums;
  for (std::size_t k = 0; k < lags.size(); ++k) {
    const double lag = lags[k];
    const double before = k > 0 ? 0.5 * (lag - lags[k - 1]) : 0.5;
    const double after = k + 1 < lags.size() ? 0.5 * (lags[k + 1] - lag) : 0.5;
    const double pairs =
        std::min(first.starts, second.starts - lag) - std::max(0.0, -lag);
    const double weight = pairs * (before + after);
    const double covariance = covariance_at(r, terms, lag);
    sums.covariance += weight * covariance;
    sums.squares += weight * covariance * covariance;
  }
  const double all = first.starts * second.starts;
  return {sums.covariance / all, sums.squares / all};
}

double variance_of_difference(const std::function<double(double)>& r,
                              const AngleDifferences& differences) {
  return covariance_at(r, shifted_terms(differences, differences), 0.0);
}

}  // namespace beamgyro::internal
