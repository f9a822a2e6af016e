// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "sim/scenario/scenario.h"

namespace beamgyro::internal {
namespace {

// Borders at one time, and where they move.
struct Cluster {
  double first, last;  // [s]
  bool jump;
  double target;  // [s]
};

// The points of a profile; two at one time are a jump.
void add_borders(const PiecewiseLinear& profile, std::vector<Border>& borders) {
  const std::vector<double>& times = profile.times();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool jump = i > 0 && is_same_time(times[i - 1], times[i]);
    borders.push_back({times[i], jump});
  }
}

template <class Visit>
void visit_profiles(ScenarioPlan& scenario, const Visit& visit) {
  visit(scenario.ambient);
  for (RateProfile& profile : scenario.motion)
    if (auto* points = std::get_if<PiecewiseLinear>(&profile)) visit(*points);
}

double target_of(const Cluster& cluster, double output_rate) {
  const auto within = [&](double t) {
    return std::clamp(t, cluster.first, cluster.last);
  };
  const double sample = std::round(cluster.last * output_rate) / output_rate;
  if (is_same_time(sample, within(sample))) return sample;
  // Up to here numbers of nine decimals are distinct doubles.
  constexpr double kDecimal = 1e6;  // [s]
  constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
  const double decimal = std::round(cluster.last * 1e9) / 1e9;
  const double distance = std::abs(decimal - within(decimal));
  const bool is_decimal = std::abs(cluster.last) < kDecimal &&
                          distance <= kRounding * std::abs(decimal);
  return is_decimal ? decimal : cluster.last;
}

std::vector<Cluster> clusters_of(std::vector<Border> borders,
                                 double output_rate) {
  std::sort(borders.begin(), borders.end(),
            [](const Border& a, const Border& b) { return a.time < b.time; });
  std::vector<Cluster> clusters;
  for (const auto& [t, jump] : borders) {
    if (clusters.empty() || !is_same_time(clusters.back().last, t)) {
      clusters.push_back({t, t, jump, t});
    } else {
      clusters.back().last = t;
      clusters.back().jump |= jump;
    }
  }
  std::erase_if(clusters, [](const Cluster& cluster) {
    return !cluster.jump && cluster.first == cluster.last;
  });
  for (Cluster& cluster : clusters)
    cluster.target = target_of(cluster, output_rate);
  return clusters;
}

double moved(double t, const std::vector<Cluster>& clusters) {
  const auto cluster = std::lower_bound(
      clusters.begin(), clusters.end(), t,
      [](const Cluster& c, double time) { return c.last < time; });
  return cluster != clusters.end() && t >= cluster->first ? cluster->target : t;
}

// The profile over the moved times; of more than two points at one time the
// first and the last remain.
PiecewiseLinear moved(const PiecewiseLinear& profile,
                      const std::vector<Cluster>& clusters) {
  std::vector<double> time, value;
  for (std::size_t i = 0; i < profile.times().size(); ++i) {
    const double t = moved(profile.times()[i], clusters);
    const std::size_t n = time.size();
    if (n >= 2 && time[n - 2] == t) {
      value.back() = profile.values()[i];
      continue;
    }
    time.push_back(t);
    value.push_back(profile.values()[i]);
  }
  return {std::move(time), std::move(value)};
}

}  // namespace

ScenarioPlan with_aligned_borders(const ScenarioPlan& scenario) {
  ScenarioPlan aligned = scenario;
  std::vector<Border> borders;
  for (const PowerInterval& interval : scenario.powered) {
    borders.push_back({interval.on, true});
    if (std::isfinite(interval.off)) borders.push_back({interval.off, true});
  }
  visit_profiles(aligned, [&](const PiecewiseLinear& profile) {
    add_borders(profile, borders);
  });
  const std::vector<Cluster> clusters =
      clusters_of(std::move(borders), scenario.output_rate);
  for (PowerInterval& interval : aligned.powered) {
    interval.on = moved(interval.on, clusters);
    interval.off = moved(interval.off, clusters);
  }
  visit_profiles(aligned, [&](PiecewiseLinear& profile) {
    profile = moved(profile, clusters);
  });
  return aligned;
}

}  // namespace beamgyro::internal
