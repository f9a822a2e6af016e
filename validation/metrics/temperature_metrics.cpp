// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include "compensation/scoring/residual_scores.h"
#include "validation/metrics/largest_figure.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/noisy_means.h"
#include "validation/metrics/soaks.h"

namespace beamgyro::internal {
namespace {

constexpr double kSameSoakTemperature = 0.5;  // [K]
constexpr double kLeastSlope = 0.05;          // [K/min], of a ramp
constexpr double kSameSlope = 0.1;            // [-], of ramps
constexpr std::size_t kLeastLegBlocks = 5;    // blocks of a ramp

struct Soaks {
  NoisyMeans means;
  std::vector<Soak> soaks;  // one for each mean
};

Soaks all_soaks(const Evidence& evidence) {
  Soaks all;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kSoak})) {
    const std::vector<Soak> soaks = soaks_of(*run->recording);
    all.means.add(*run, ranges_of(soaks));
    all.soaks.insert(all.soaks.end(), soaks.begin(), soaks.end());
  }
  return all;
}

std::optional<Estimate> soak_figure(const Evidence& evidence,
                                    double ResidualScores::*figure,
                                    Estimator estimate) {
  const Soaks all = all_soaks(evidence);
  if (all.soaks.size() < 2) return std::nullopt;
  return estimate(all.means, [figure](std::span<const double> b) {
    return residual_scores(b).*figure;
  });
}

/// A mean, and the line between two others that it is compared with.
struct Comparison {
  std::size_t here;
  std::size_t left, right;
  double share;  // [-], of the right one
};

double difference(const Comparison& c, std::span<const double> b) {
  return b[c.here] - (1.0 - c.share) * b[c.left] - c.share * b[c.right];
}

std::vector<double> differences(const std::vector<Comparison>& comparisons,
                                std::span<const double> b) {
  std::vector<double> all;
  for (const Comparison& c : comparisons) all.push_back(difference(c, b));
  return all;
}

Estimate largest_difference(const NoisyMeans& means,
                            const std::vector<Comparison>& comparisons) {
  return estimate_of_largest(means, [&](std::span<const double> b) {
    return differences(comparisons, b);
  });
}

Estimate rms_difference(const NoisyMeans& means,
                        const std::vector<Comparison>& comparisons) {
  return estimate_of_root(means, [&](std::span<const double> b) {
    double squares = 0.0;
    for (const Comparison& c : comparisons)
      squares += std::pow(difference(c, b), 2);
    return std::sqrt(squares / static_cast<double>(comparisons.size()));
  });
}

/// Part of a ramp run in one direction: indices of means, rising temperature.
struct Leg {
  std::vector<std::size_t> blocks;
  double slope;  // [K/min]
};

/// Temperature [degC] that tells the direction of a ramp.
std::vector<double> chamber_temperatures(const Recording& recording,
                                         std::span<const Segment> blocks) {
  const Column* ambient = find_column(recording, "true_ambient_temperature");
  if (ambient != nullptr) return means_over(blocks, ambient->values);
  std::vector<double> temperatures;
  for (const Segment& block : blocks) temperatures.push_back(block.temperature);
  return temperatures;
}

void add_legs(const Recording& recording, std::span<const Segment> blocks,
              std::size_t first, std::vector<Leg>& legs) {
  const std::vector<double> chamber = chamber_temperatures(recording, blocks);
  std::vector<std::size_t> leg;  // numbers within the run
  int direction = 0;
  const auto finish = [&] {
    if (direction != 0 && leg.size() >= kLeastLegBlocks) {
      const double minutes =
          (blocks[leg.back()].time - blocks[leg.front()].time) / 60.0;
      Leg found{{}, (chamber[leg.back()] - chamber[leg.front()]) / minutes};
      for (const std::size_t i : leg) found.blocks.push_back(first + i);
      if (direction < 0) std::ranges::reverse(found.blocks);
      legs.push_back(found);
    }
    leg.clear();
  };
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const double slope = 60.0 * (chamber[i] - chamber[i - 1]) /
                         (blocks[i].time - blocks[i - 1].time);
    const int now = std::abs(slope) < kLeastSlope ? 0 : slope > 0.0 ? 1 : -1;
    if (now != direction || blocks[i].power_on != blocks[i - 1].power_on) {
      finish();
      direction = now;
    }
    leg.push_back(i);
  }
  finish();
}

/// Compares every block of one leg with the line through those of the other.
void compare(const Leg& up, const Leg& down, std::span<const Segment> blocks,
             std::vector<Comparison>& comparisons) {
  for (const std::size_t here : up.blocks) {
    const double T = blocks[here].temperature;
    const auto right = std::ranges::find_if(
        down.blocks, [&](std::size_t i) { return blocks[i].temperature >= T; });
    if (right == down.blocks.begin() || right == down.blocks.end()) continue;
    const auto left = right - 1;
    const double span = blocks[*right].temperature - blocks[*left].temperature;
    comparisons.push_back(
        {here, *left, *right, (T - blocks[*left].temperature) / span});
  }
}

std::optional<Estimate> ramp_figure(
    const Evidence& evidence,
    Estimate (*figure)(const NoisyMeans&, const std::vector<Comparison>&)) {
  NoisyMeans means;
  std::vector<Leg> legs;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRamp})) {
    const std::size_t first = means.segments.size();
    means.add(*run, score_blocks(*run->recording));
    add_legs(*run->recording, std::span(means.segments).subspan(first), first,
             legs);
  }
  std::vector<Comparison> comparisons;
  for (const Leg& up : legs)
    for (const Leg& down : legs)
      if (up.slope > 0.0 && down.slope < 0.0 &&
          std::abs(up.slope + down.slope) <= kSameSlope * up.slope)
        compare(up, down, means.segments, comparisons);
  if (comparisons.empty()) return std::nullopt;
  return figure(means, comparisons);
}

std::optional<Estimate> bias_sensitivity(const Evidence& evidence) {
  const Soaks all = all_soaks(evidence);
  const auto& segments = all.means.segments;
  if (segments.size() < 2) return std::nullopt;
  double mean = 0.0;
  for (const Segment& s : segments)
    mean += s.temperature / static_cast<double>(segments.size());
  double squares = 0.0;
  for (const Segment& s : segments)
    squares += std::pow(s.temperature - mean, 2);
  if (!(squares > 0.0)) return std::nullopt;
  return estimate_beneath_noise(
      all.means,
      [&](std::span<const double> b) {
        double sum = 0.0;
        for (std::size_t j = 0; j < b.size(); ++j)
          sum += (segments[j].temperature - mean) * b[j];
        return sum / squares;
      },
      Shrinkage::kNone);
}

std::optional<Estimate> bias_sensitivity_max(const Evidence& evidence) {
  const Soaks all = all_soaks(evidence);
  const auto& segments = all.means.segments;
  std::vector<std::size_t> order(segments.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {},
                    [&](std::size_t j) { return segments[j].temperature; });
  // Soaks at one temperature count as one.
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t j : order) {
    if (groups.empty() ||
        segments[j].temperature - segments[groups.back()[0]].temperature >
            kSameSoakTemperature)
      groups.emplace_back();
    groups.back().push_back(j);
  }
  if (groups.size() < 3) return std::nullopt;
  const auto mean_of_group = [&](std::size_t g, auto value) {
    double sum = 0.0;
    for (const std::size_t j : groups[g]) sum += value(j);
    return sum / static_cast<double>(groups[g].size());
  };
  return estimate_of_largest(all.means, [&](std::span<const double> b) {
    const auto bias_at = [&](std::size_t j) { return b[j]; };
    const auto temperature = [&](std::size_t j) {
      return segments[j].temperature;
    };
    std::vector<double> slopes;
    for (std::size_t g = 1; g + 1 < groups.size(); ++g)
      slopes.push_back(
          (mean_of_group(g + 1, bias_at) - mean_of_group(g - 1, bias_at)) /
          (mean_of_group(g + 1, temperature) -
           mean_of_group(g - 1, temperature)));
    return slopes;
  });
}

std::optional<Estimate> soak_hysteresis_max(const Evidence& evidence) {
  const Soaks all = all_soaks(evidence);
  std::vector<Comparison> comparisons;
  for (std::size_t i = 0; i < all.soaks.size(); ++i)
    for (std::size_t j = 0; j < all.soaks.size(); ++j)
      if (all.soaks[i].reached == Direction::kUp &&
          all.soaks[j].reached == Direction::kDown &&
          std::abs(all.soaks[i].ambient - all.soaks[j].ambient) <
              kSameSoakTemperature)
        comparisons.push_back({i, j, j, 0.0});
  if (comparisons.empty()) return std::nullopt;
  return largest_difference(all.means, comparisons);
}

std::optional<Estimate> bias(const Evidence& evidence) {
  NoisyMeans means;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRest}))
    means.add(*run, score_blocks(*run->recording));
  if (means.values.empty()) return std::nullopt;
  return estimate_beneath_noise(
      means, [](std::span<const double> r) { return residual_scores(r).mean; },
      Shrinkage::kNone);
}

}  // namespace

std::vector<Metric> temperature_metrics() {
  using enum RunPurpose;
  return {
      {"bias_deg_per_s",
       "Bias",
       "deg/s",
       "12.11",
       "Mean of the residual (judged rate less true rate) over runs at "
       "rest.",
       {kRest},
       bias},
      {"bias_pp_deg_per_s",
       "Peak-to-peak bias",
       "deg/s",
       "12.11",
       "max B(T_j) - min B(T_j): B(T_j) is the mean residual over the "
       "last 300 s of soak j.",
       {kSoak},
       given(soak_figure, &ResidualScores::peak_to_peak, estimate_of_range)},
      {"bias_sigma_deg_per_s",
       "Standard deviation of the bias",
       "deg/s",
       "12.11",
       "Standard deviation of the B(T_j) about their mean, divided by "
       "their number n.",
       {kSoak},
       given(soak_figure, &ResidualScores::sigma, estimate_of_root)},
      {"bias_sensitivity_deg_per_s_per_K",
       "Bias sensitivity to temperature",
       "deg/s/K",
       "12.11",
       "Slope of the least-squares line of B(T_j) over the measured "
       "temperature T_j.",
       {kSoak},
       bias_sensitivity},
      {"bias_sensitivity_max_deg_per_s_per_K",
       "Largest bias sensitivity to temperature",
       "deg/s/K",
       "12.11",
       "max |B(T_j+1) - B(T_j-1)| / |T_j+1 - T_j-1| over the soaks in "
       "order of temperature.",
       {kSoak},
       bias_sensitivity_max},
  };
}

std::vector<Metric> hysteresis_metrics() {
  using enum RunPurpose;
  return {
      {"hysteresis_max_deg_per_s",
       "Largest hysteresis of ramps",
       "deg/s",
       "",
       "max over T of |B_up(T) - B_down(T)| at the same measured "
       "temperature, between ramps of equal slope.",
       {kRamp},
       given(ramp_figure, &largest_difference)},
      {"hysteresis_rms_deg_per_s",
       "Rms hysteresis of ramps",
       "deg/s",
       "",
       "rms over T of B_up(T) - B_down(T) at the same measured "
       "temperature, between ramps of equal slope.",
       {kRamp},
       given(ramp_figure, &rms_difference)},
      {"soak_hysteresis_max_deg_per_s",
       "Largest hysteresis of soaks",
       "deg/s",
       "",
       "max |B_up(T_j) - B_down(T_j)| between soaks at one ambient "
       "temperature that were reached from below and from above.",
       {kSoak},
       soak_hysteresis_max},
  };
}

}  // namespace beamgyro::internal
