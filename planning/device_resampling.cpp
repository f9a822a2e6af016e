// SPDX-License-Identifier: MIT
#include "planning/device_resampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr std::uint32_t kResamples = 400;

// How often each device is in a resample.
using Counts = std::vector<std::size_t>;

Counts resampled(std::size_t devices, std::uint32_t number) {
  Counts counts(devices, 0);
  RandomStream stream(0, number, 0, kPlanGainStream);
  for (std::size_t k = 0; k < devices; ++k)
    ++counts[static_cast<std::size_t>(stream.uniform() *
                                      static_cast<double>(devices))];
  return counts;
}

// Draws in the order of their size, so that quantiles of a resample need no
// sorting.
class SortedDraws {
 public:
  explicit SortedDraws(const ResidualDraws& draws)
      : draws_(draws), order_(draws.rms.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::sort(order_, {}, [&](std::size_t k) { return draws.rms[k]; });
  }

  // The values below which these shares, increasing, of a resample lie.
  template <std::size_t size>
  std::array<double, size> quantiles(
      const Counts& counts, const std::array<double, size>& shares) const {
    std::array<double, size> found = {};
    const auto last = static_cast<double>(order_.size() - 1);
    std::size_t seen = 0, next = 0;
    for (const std::size_t k : order_) {
      seen += counts[k % draws_.devices];
      const auto below = static_cast<double>(seen);
      while (next != size && below > std::round(shares[next] * last))
        found[next++] = draws_.rms[k];
    }
    return found;
  }

 private:
  const ResidualDraws& draws_;
  std::vector<std::size_t> order_;
};

Interval interval_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {percentile(values, kIntervalTail),
          percentile(values, 1.0 - kIntervalTail)};
}

}  // namespace

ResidualForecast forecast_with_intervals(const ResidualDraws& draws) {
  const SortedDraws sorted(draws);
  std::array<std::vector<double>, 3> found;
  for (std::uint32_t k = 0; k < kResamples; ++k) {
    const auto quantiles =
        sorted.quantiles<3>(resampled(draws.devices, k), {kForecastShares});
    for (std::size_t q = 0; q < quantiles.size(); ++q)
      found[q].push_back(quantiles[q]);
  }
  ResidualForecast forecast = forecast_of(draws);
  forecast.intervals = {interval_of(found[0]), interval_of(found[1]),
                        interval_of(found[2])};
  return forecast;
}

MedianRatio ratio_of_medians(const ResidualDraws& draws,
                             const ResidualDraws& others) {
  const SortedDraws sorted(draws), sorted_others(others);
  const auto ratio = [&](const Counts& counts) {
    return sorted.quantiles<1>(counts, {0.5})[0] /
           sorted_others.quantiles<1>(counts, {0.5})[0];
  };
  std::vector<double> found;
  for (std::uint32_t k = 0; k < kResamples; ++k)
    found.push_back(ratio(resampled(draws.devices, k)));
  return {ratio(Counts(draws.devices, 1)), interval_of(std::move(found))};
}

}  // namespace beamgyro::internal
