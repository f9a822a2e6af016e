// SPDX-License-Identifier: MIT
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "compensation/scoring/residual_scores.h"
#include "random/random_stream.h"
#include "validation/metrics/largest_figure.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal {
namespace {

constexpr double kWarmUpBand = 0.05;      // [-], of the whole change
constexpr double kNoiseBand = 3.0;        // [-], sigma
constexpr double kEndShare = 0.1;         // [-], of the blocks of a warm-up
constexpr double kSmoothing = 0.05;       // [-], of the time from power-on
constexpr std::size_t kLeastBlocks = 10;  // of a warm-up
constexpr std::size_t kLeastCycles = 3;
constexpr double kZeroing = 10.0;  // [s], the user's zero, and each mean
constexpr std::uint32_t kWarmUpDraws = 200;

std::vector<RunPurpose> power_on_purposes() {
  return {RunPurpose::kWarmUp, RunPurpose::kPowerCycle};
}

/// B_end, the mean of the blocks at the end of a warm-up.
double settled_mean(std::span<const double> blocks) {
  const double share = kEndShare * static_cast<double>(blocks.size());
  return mean_of(blocks.last(
      std::max<std::size_t>(1, static_cast<std::size_t>(std::round(share)))));
}

/// B(t) - B_end of a warm-up, smoothed over 5 % of the time from power-on.
std::vector<double> distances(std::span<const double> blocks) {
  const std::size_t n = blocks.size();
  const double settled = settled_mean(blocks);
  std::vector<double> d;
  for (std::size_t i = 0; i < n; ++i) {
    const auto reach =
        static_cast<std::size_t>(kSmoothing * (static_cast<double>(i) + 0.5));
    const std::size_t side = std::min(reach, n - 1 - i);
    d.push_back(mean_of(blocks.subspan(i - side, 2 * side + 1)) - settled);
  }
  return d;
}

/// Time [s] at which |d| last crosses the band; 0 if it never leaves it.
double last_crossing(std::span<const Segment> blocks, std::span<const double> d,
                     std::span<const double> band) {
  for (std::size_t i = d.size(); i-- > 0;) {
    const double above = std::abs(d[i]) - band[i];
    if (above <= 0.0) continue;
    if (i + 1 == d.size()) return blocks[i].powered;
    const double below = band[i + 1] - std::abs(d[i + 1]);
    return blocks[i].powered + (blocks[i + 1].powered - blocks[i].powered) *
                                   above / (above + below);
  }
  return 0.0;
}

/// |B(0) - B_end| [deg/s]: the first two means of 10 s, carried on to power-on.
double whole_change(const Recording& recording,
                    std::span<const double> residual,
                    std::span<const Segment> blocks,
                    std::span<const double> values) {
  const auto zeroing = static_cast<std::size_t>(
      std::max(1.0, std::round(kZeroing / usual_step(recording))));
  const std::size_t first = blocks[0].samples.begin;
  const double early = mean_of(residual.subspan(first, zeroing));
  const double later = mean_of(residual.subspan(first + zeroing, zeroing));
  return std::abs(1.5 * early - 0.5 * later - settled_mean(values));
}

/// Warm-up time of one power-on.
Estimate warm_up_of(std::span<const Segment> blocks,
                    std::span<const double> values, const SegmentNoise& noise,
                    double change) {
  const std::vector<double> d = distances(values);
  // The noise of d.
  std::vector<double> sigma(d.size(), 0.0);
  if (!noise.none()) {
    std::vector<double> drawn(d.size());
    for (std::uint32_t draw = 0; draw < kWarmUpDraws; ++draw) {
      RandomStream random(0, draw, 0, kIntervalStream);
      noise.draw(random, drawn);
      const std::vector<double> n = distances(drawn);
      for (std::size_t i = 0; i < n.size(); ++i) sigma[i] += n[i] * n[i];
    }
    for (double& s : sigma) s = std::sqrt(s / kWarmUpDraws);
  }
  std::vector<double> band, wide, narrow;
  for (const double s : sigma) {
    band.push_back(std::max(kWarmUpBand * change, kNoiseBand * s));
    wide.push_back(band.back() + kNormal975 * s);
    narrow.push_back(band.back() - kNormal975 * s);
  }
  return {last_crossing(blocks, d, band),
          Interval{last_crossing(blocks, d, wide),
                   last_crossing(blocks, d, narrow)}};
}

/// The later of two times.
std::optional<Estimate> longest_of(const std::optional<Estimate>& a,
                                   const Estimate& b) {
  if (!a) return b;
  return Estimate{std::max(a->value, b.value),
                  Interval{std::max(a->interval->low, b.interval->low),
                           std::max(a->interval->high, b.interval->high)}};
}

/// Means of 10 s from each power-on, as long as `length` [s] and complete.
NoisyMeans power_on_means(const Evidence& evidence, double length,
                          std::size_t& of_each) {
  NoisyMeans means;
  of_each = static_cast<std::size_t>(std::round(length / kZeroing)) + 1;
  for (const EvidenceRun* run : runs_for(evidence, power_on_purposes())) {
    const Recording& recording = *run->recording;
    const auto blocks =
        segments_of(recording, score_blocks(recording, kZeroing));
    std::vector<SampleRange> ranges;
    for (std::size_t i = 0; i + of_each <= blocks.size();) {
      std::size_t same = i;
      while (same < blocks.size() &&
             blocks[same].power_on == blocks[i].power_on)
        ++same;
      const double reach = blocks[i + of_each - 1].powered - blocks[i].powered;
      if (same - i >= of_each && blocks[i].powered < kZeroing &&
          std::abs(reach - length) < kZeroing)
        for (std::size_t j = i; j < i + of_each; ++j)
          ranges.push_back(blocks[j].samples);
      i = same;
    }
    if (ranges.empty()) continue;
    means.add(*run, ranges);
  }
  return means;
}

/// Figures of one power-on, appended to those of others.
using AddFigures = void (*)(std::span<const double> from_power_on,
                            std::vector<double>& figures);

std::optional<Estimate> worst_power_on(const Evidence& evidence, double length,
                                       AddFigures add) {
  std::size_t of_each = 0;
  const NoisyMeans means = power_on_means(evidence, length, of_each);
  if (means.values.empty()) return std::nullopt;
  return estimate_of_largest(means, [&](std::span<const double> b) {
    std::vector<double> figures;
    for (std::size_t i = 0; i < b.size(); i += of_each)
      add(b.subspan(i, of_each), figures);
    return figures;
  });
}

void add_departures(std::span<const double> b, std::vector<double>& figures) {
  for (const double value : b.subspan(1)) figures.push_back(value - b[0]);
}

void add_heading_error(std::span<const double> b,
                       std::vector<double>& figures) {
  double angle = 0.0;
  for (const double value : b.subspan(1)) angle += kZeroing * (value - b[0]);
  figures.push_back(angle);
}

std::optional<Estimate> turn_on_time(const Evidence& evidence) {
  using enum RunPurpose;
  std::optional<double> longest;
  for (const EvidenceRun* run :
       runs_for(evidence, {kWarmUp, kPowerCycle, kRateStep})) {
    const Recording& recording = *run->recording;
    if (recording.fidelity == "quasistatic" || recording.fidelity == "imported")
      continue;
    for (const SampleRange& stretch : powered_stretches(recording)) {
      std::size_t locked = stretch.end;
      while (locked > stretch.begin &&
             (recording.status[locked - 1] & kLoopNotLocked) == 0)
        --locked;
      if (locked == stretch.end) continue;  // never locked
      const double time =
          recording.time[locked] - recording.time[stretch.begin];
      longest = std::max(longest.value_or(0.0), time);
    }
  }
  if (!longest) return std::nullopt;
  return Estimate{*longest};
}

std::optional<Estimate> warm_up_time(const Evidence& evidence) {
  std::optional<Estimate> longest;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kWarmUp})) {
    const std::vector<double> residual = residual_of(*run);
    const NoiseLevels levels = seen_noise(*run->recording, residual);
    const auto all =
        segments_of(*run->recording, score_blocks(*run->recording));
    for (auto begin = all.begin(); begin != all.end();) {
      const auto end = std::find_if(begin, all.end(), [&](const Segment& s) {
        return s.power_on != begin->power_on;
      });
      const std::span<const Segment> blocks(begin, end);
      begin = end;
      if (blocks.size() < kLeastBlocks) continue;
      const std::vector<double> values = means_over(blocks, residual);
      if (!std::ranges::all_of(values,
                               [](double v) { return std::isfinite(v); }))
        return Estimate{NAN};
      longest = longest_of(
          longest,
          warm_up_of(blocks, values, SegmentNoise(levels, blocks),
                     whole_change(*run->recording, residual, blocks, values)));
    }
  }
  return longest;
}

std::optional<Estimate> turn_on_repeatability(const Evidence& evidence) {
  double squares = 0.0;
  double freedom = 0.0;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kPowerCycle})) {
    const auto cycles = powered_stretches(*run->recording);
    if (cycles.size() < kLeastCycles) continue;
    const std::size_t shortest =
        std::ranges::min(cycles, {}, &SampleRange::size).size();
    const std::vector<double> residual = residual_of(*run);
    std::vector<double> means;
    for (const SampleRange& cycle : cycles)
      means.push_back(
          mean_of(std::span(residual).subspan(cycle.begin, shortest)));
    const double mean = mean_of(means);
    for (const double m : means) squares += (m - mean) * (m - mean);
    freedom += static_cast<double>(means.size() - 1);
  }
  if (!(freedom > 0.0)) return std::nullopt;
  const double sigma = std::sqrt(squares / freedom);
  const boost::math::chi_squared chance(freedom);
  return Estimate{sigma,
                  Interval{std::sqrt(squares / quantile(chance, 0.975)),
                           std::sqrt(squares / quantile(chance, 0.025))}};
}

std::optional<Estimate> in_run_stability(const Evidence& evidence) {
  constexpr double kBlock = 100.0;     // [s]
  constexpr double kLongest = 3600.0;  // [s]
  constexpr std::size_t kLeast = 10;   // means
  NoisyMeans means;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRest})) {
    const Recording& recording = *run->recording;
    auto blocks = score_blocks(recording, kBlock);
    const double from =
        recording.time.back() - kLongest - usual_step(recording);
    std::erase_if(blocks, [&](const SampleRange& block) {
      return recording.time[block.begin] <= from;
    });
    if (blocks.size() < kLeast) continue;
    means.add(*run, blocks);
  }
  if (means.values.empty()) return std::nullopt;
  return estimate_of_noise(means, [&](std::span<const double> b) {
    double squares = 0.0;
    std::size_t first = 0;
    for (const std::size_t size : means.sizes) {
      squares += residual_scores(b.subspan(first, size)).variance *
                 static_cast<double>(size);
      first += size;
    }
    return std::sqrt(squares /
                     static_cast<double>(b.size() - means.sizes.size()));
  });
}

}  // namespace

std::vector<Metric> start_metrics() {
  using enum RunPurpose;
  return {
      {"turn_on_time_s",
       "Turn-on time",
       "s",
       "12.5",
       "Longest time from power-on until the loops stay locked. Not of "
       "a quasi-static run, which has no start-up.",
       {kWarmUp, kPowerCycle, kRateStep},
       turn_on_time},
      {"warm_up_time_s",
       "Warm-up time",
       "s",
       "12.6",
       "Longest time from power-on after which |B(t) - B_end| stays "
       "within the greater of 5 % of |B(0) - B_end| and 3 sigma of the "
       "noise of that difference.",
       {kWarmUp},
       warm_up_time},
      {"turn_on_repeatability_deg_per_s",
       "Turn-on bias repeatability",
       "deg/s",
       "12.11",
       "sqrt(sum (B_i - mean)^2 / (n - 1)): B_i is the mean residual of "
       "power cycle i over the same time from power-on, pooled over "
       "runs.",
       {kPowerCycle},
       turn_on_repeatability},
      {"in_run_stability_deg_per_s",
       "In-run bias stability",
       "deg/s",
       "12.11",
       "sqrt(sum (b_i - mean)^2 / (n - 1)) of the means b_i of 100 s "
       "over the last hour of a run at rest, pooled over runs.",
       {kRest},
       in_run_stability},
      {"power_on_drift_3_min_deg_per_s", "Drift within 3 min of power-on",
       "deg/s", "",
       "Largest |b(t) - b(0)| within 3 min from power-on: b are means "
       "of 10 s, b(0) the first one, with which the user zeroes the "
       "gyro.",
       power_on_purposes(),
       given(worst_power_on, 180.0 - kZeroing, &add_departures)},
      {"heading_error_1_min_deg", "Heading error after 1 min", "deg", "",
       "Largest |integral of the residual over 1 min|, from 10 s after "
       "power-on, less the mean of those 10 s, with which the user "
       "zeroes the gyro.",
       power_on_purposes(), given(worst_power_on, 60.0, &add_heading_error)},
      {"heading_error_10_min_deg", "Heading error after 10 min", "deg", "",
       "Largest |integral of the residual over 10 min|, from 10 s after "
       "power-on, less the mean of those 10 s, with which the user "
       "zeroes the gyro.",
       power_on_purposes(), given(worst_power_on, 600.0, &add_heading_error)},
  };
}

}  // namespace beamgyro::internal
