// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_trajectory.h"

#include <algorithm>
#include <limits>

namespace beamgyro::internal {
namespace {

constexpr std::size_t kNodes = kThermalNodeCount;

}  // namespace

ThermalTrajectory::ThermalTrajectory(const ThermalNetwork& network,
                                     const ThermalLoad& load,
                                     const SampleGrid& grid,
                                     const ThermalSink& also)
    : grid_(grid) {
  if (grid.count == 0) return;
  const auto first_after = [&](double t) {
    const std::size_t k = grid_.first_from(t);
    return k < grid_.count && grid_.time(k) == t ? k + 1 : k;
  };
  integrate_temperatures(network, load, grid.time(grid.count - 1),
                         {.on_state =
                              [&](double t, const auto& y) {
                                store(first_after(t), y);
                                if (also.on_state) also.on_state(t, y);
                              },
                          .on_step =
                              [&](const OdeStep& s) {
                                store(grid_.first_from(s.end), s);
                                if (also.on_step) also.on_step(s);
                              }});
}

void ThermalTrajectory::begin_values() {
  if (stretches_.empty() || stretches_.back().order != kValues)
    stretches_.push_back({kept_, data_.size(), 0, 1, kValues});
}

void ThermalTrajectory::store(std::size_t last, const Eigen::VectorXd& y) {
  if (last <= kept_) return;
  begin_values();
  for (; kept_ < last; ++kept_)
    data_.insert(data_.end(), y.begin(), y.begin() + kThermalNodeCount);
}

void ThermalTrajectory::store(std::size_t last, const OdeStep& step) {
  if (last <= kept_) return;
  const auto terms = static_cast<std::size_t>(step.order) + 1;
  if (last - kept_ > terms) {
    stretches_.push_back({kept_, data_.size(), step.centre, step.size,
                          static_cast<int>(step.order)});
    for (Eigen::Index node = 0; node < kThermalNodeCount; ++node) {
      for (Eigen::Index k = 0; k <= step.order; ++k)
        data_.push_back(step.coefficients(node, k));
    }
    kept_ = last;
    return;
  }
  begin_values();
  for (; kept_ < last; ++kept_) {
    const double t = grid_.time(kept_);
    for (Eigen::Index node = 0; node < kThermalNodeCount; ++node)
      step.sample(node, {&t, 1}, {&data_.emplace_back(), 1});
  }
}

TemperatureSpan ThermalTrajectory::range(ThermalNode node) const {
  constexpr std::size_t kBlock = 4096;
  std::vector<double> block;
  TemperatureSpan range{std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < grid_.count; k += kBlock) {
    block.resize(std::min(kBlock, grid_.count - k));
    sample(node, k, grid_.times(k, block.size()), block);
    const auto [low, high] = std::minmax_element(block.begin(), block.end());
    range = {std::min(range.low, *low), std::max(range.high, *high)};
  }
  return range;
}

void ThermalTrajectory::sample(ThermalNode node, std::size_t first,
                               std::span<const double> times,
                               std::span<double> temperature) const {
  auto stretch = std::upper_bound(
      stretches_.begin(), stretches_.end(), first,
      [](std::size_t k, const Stretch& s) { return k < s.first; });
  const std::size_t end = first + temperature.size();
  for (--stretch; first < end; ++stretch) {
    const std::size_t next =
        stretch + 1 == stretches_.end() ? end : (stretch + 1)->first;
    const std::size_t count = std::min(next, end) - first;
    const std::span<double> values = temperature.first(count);
    const double* data = data_.data() + stretch->data;
    if (stretch->order == kValues) {
      data += (first - stretch->first) * kNodes + node;
      for (std::size_t i = 0; i < count; ++i) values[i] = data[i * kNodes];
    } else {
      const auto terms = static_cast<std::size_t>(stretch->order) + 1;
      sample_polynomial({data + node * terms, terms}, stretch->centre,
                        stretch->size, times.first(count), values);
    }
    first += count;
    times = times.subspan(count);
    temperature = temperature.subspan(count);
  }
}

}  // namespace beamgyro::internal
