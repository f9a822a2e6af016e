// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "compensation/scoring/linearity.h"
#include "compensation/scoring/scale_factor.h"
#include "validation/metrics/largest_figure.h"
#include "validation/metrics/metric_tables.h"
#include "validation/metrics/noisy_means.h"

namespace beamgyro::internal {
namespace {

constexpr double kPpm = 1e6;
constexpr double kTableReference = 25.0;       // [degC]
constexpr double kLeastTemperatureSpan = 1.0;  // [K]

/// The rates of one table: which means belong to each.
struct RateTable {
  std::map<double, std::vector<std::size_t>> means_at;  // by rate [deg/s]
  double temperature = 0.0;                             // [degC], mean
};

std::vector<HeldRate> held_rates_of(const RateTable& table,
                                    std::span<const double> means) {
  std::vector<HeldRate> held;
  for (const auto& [rate, indices] : table.means_at) {
    double sum = 0.0;
    for (const std::size_t i : indices) sum += means[i];
    held.push_back({rate, sum / static_cast<double>(indices.size())});
  }
  return held;
}

struct RateTables {
  NoisyMeans means;  // judged rates
  std::vector<RateTable> tables;
};

/// The settled and unsaturated part of every held rate within `plateau`.
std::vector<SampleRange> settled_rates(const Recording& recording,
                                       std::span<const SampleRange> held,
                                       const SampleRange& plateau) {
  std::vector<SampleRange> ranges;
  for (SampleRange range : held) {
    range.begin = std::max(range.begin, plateau.begin);
    range.end = std::min(range.end, plateau.end);
    if (range.begin >= range.end) continue;
    range = settled(recording, range, kSettlingTime);
    const bool saturated = std::any_of(
        recording.status.begin() + static_cast<std::ptrdiff_t>(range.begin),
        recording.status.begin() + static_cast<std::ptrdiff_t>(range.end),
        [](std::uint8_t status) { return (status & kOutputSaturated) != 0; });
    if (range.size() > 0 && !saturated) ranges.push_back(range);
  }
  return ranges;
}

/// Adds the table over the held rates of a plateau, if they are one.
bool add_table(const Recording& recording, const std::vector<double>& truth,
               std::span<const SampleRange> ranges,
               std::vector<SampleRange>& used, std::size_t first,
               std::vector<RateTable>& tables) {
  RateTable table;
  std::size_t next = first + used.size();
  double samples = 0.0;
  for (const Segment& segment : segments_of(recording, ranges)) {
    const auto size = static_cast<double>(segment.samples.size());
    table.means_at[truth[segment.samples.begin]].push_back(next++);
    table.temperature += segment.temperature * size;
    samples += size;
  }
  std::vector<HeldRate> rates;
  for (const auto& [rate, indices] : table.means_at)
    rates.push_back({rate, 0.0});
  if (!is_rate_table(rates)) return false;
  table.temperature /= samples;
  used.insert(used.end(), ranges.begin(), ranges.end());
  tables.push_back(table);
  return true;
}

RateTables rate_tables_of(const Evidence& evidence) {
  RateTables all;
  for (const EvidenceRun* run : runs_for(evidence, {RunPurpose::kRateTable})) {
    const Recording& recording = *run->recording;
    const auto& truth = column_values(recording, "true_rate");
    const std::vector<SampleRange> held =
        held_ranges(recording, std::array{&truth});
    const std::size_t first = all.means.values.size();
    std::vector<SampleRange> used;
    bool found = false;
    for (const SampleRange& plateau : temperature_plateaus(recording))
      found |=
          add_table(recording, truth, settled_rates(recording, held, plateau),
                    used, first, all.tables);
    if (!found)  // the temperature moves along the table
      add_table(recording, truth,
                settled_rates(recording, held, {0, truth.size()}), used, first,
                all.tables);
    all.means.add(*run, used, run->rate);
  }
  return all;
}

using FiguresOfTable = std::vector<double> (*)(const Linearity& table);
using EstimateOfLargest = Estimate (*)(const NoisyMeans& means,
                                       const Candidates& candidates);

/// The largest figure of all tables.
std::optional<Estimate> largest_of_tables(const Evidence& evidence,
                                          FiguresOfTable figures_of,
                                          EstimateOfLargest estimate) {
  const RateTables all = rate_tables_of(evidence);
  if (all.tables.empty()) return std::nullopt;
  return estimate(all.means, [&](std::span<const double> means) {
    std::vector<double> figures;
    for (const RateTable& table : all.tables)
      std::ranges::copy(figures_of(linearity_of(held_rates_of(table, means))),
                        std::back_inserter(figures));
    return figures;
  });
}

/// White noise of the difference of judged and recorded rate.
double white_noise_of_correction(const EvidenceRun& run) {
  const auto& raw = column_values(*run.recording, "rate");
  std::vector<double> correction(raw.size());
  std::ranges::transform(run.rate, raw, correction.begin(), std::minus<>());
  Recording bare;  // without a device that states the noise of the rate
  bare.time = run.recording->time;
  bare.status = run.recording->status;
  bare.columns = {*find_column(*run.recording, "true_rate")};
  return seen_noise(bare, correction).angle_random_walk;
}

std::vector<RunPurpose> turning_purposes() {
  using enum RunPurpose;
  return {kRateTable, kSineRate, kRateStep, kRandomRate};
}

std::optional<Estimate> retained(const Evidence& evidence,
                                 double largest_rate) {
  SlopeSums sums;
  double variance = 0.0;  // of sums.compensated
  for (const EvidenceRun* run : runs_for(evidence, turning_purposes())) {
    const SlopeSums own = slope_sums(*run->recording, run->rate, largest_rate);
    const SlopeSums more = own.by_power();
    const double step = usual_step(*run->recording);
    sums += more;
    if (own.truth > 0.0)
      variance += std::pow(white_noise_of_correction(*run) * more.truth, 2) /
                  (step * own.truth);
  }
  const auto share = share_retained(sums);
  if (!share) return std::nullopt;
  const double half = kNormal975 * std::sqrt(variance) / std::abs(sums.raw);
  return Estimate{*share, Interval{*share - half, *share + half}};
}

std::optional<Estimate> mean_scale_factor(const Evidence& evidence) {
  const RateTables all = rate_tables_of(evidence);
  if (all.tables.empty()) return std::nullopt;
  return estimate_beneath_noise(
      all.means,
      [&](std::span<const double> means) {
        double sum = 0.0;
        for (const RateTable& table : all.tables)
          sum += linearity_of(held_rates_of(table, means)).slope;
        return sum / static_cast<double>(all.tables.size());
      },
      Shrinkage::kNone);
}

std::vector<double> error_of(const Linearity& table) {
  return {kPpm * (table.slope - 1.0)};
}

std::vector<double> departures_of(const Linearity& table) {
  return table.departures;
}

std::vector<double> asymmetry_of(const Linearity& table) {
  return {table.asymmetry};
}

std::optional<Estimate> scale_factor_temperature_sensitivity(
    const Evidence& evidence) {
  const RateTables all = rate_tables_of(evidence);
  const auto n = static_cast<double>(all.tables.size());
  double mean = 0.0, squares = 0.0;
  for (const RateTable& table : all.tables) mean += table.temperature / n;
  for (const RateTable& table : all.tables)
    squares += std::pow(table.temperature - mean, 2);
  if (!(squares > std::pow(kLeastTemperatureSpan, 2))) return std::nullopt;
  return estimate_beneath_noise(
      all.means,
      [&](std::span<const double> means) {
        double level = 0.0, slope = 0.0;
        for (const RateTable& table : all.tables) {
          const double K = linearity_of(held_rates_of(table, means)).slope;
          level += K / n;
          slope += K * (table.temperature - mean) / squares;
        }
        return kPpm * slope / (level + slope * (kTableReference - mean));
      },
      Shrinkage::kNone);
}

}  // namespace

std::vector<Metric> scale_factor_metrics() {
  using enum RunPurpose;
  return {
      {"scale_factor",
       "Scale factor",
       "1",
       "12.9",
       "Slope K of the least-squares line of the judged rate over the "
       "held true rates, mean over the rate tables.",
       {kRateTable},
       mean_scale_factor,
       1.0},
      {"scale_factor_error_ppm",
       "Scale factor error",
       "ppm",
       "12.9",
       "max |K_j - 1| over the rate tables.",
       {kRateTable},
       given(largest_of_tables, error_of, estimate_of_largest)},
      {"scale_factor_nonlinearity_ppm",
       "Scale factor nonlinearity",
       "ppm",
       "12.9",
       "max |V_i - line| / (K max |Omega_i|): V_i is the mean answer to "
       "the held rate Omega_i; of the worst rate table.",
       {kRateTable},
       given(largest_of_tables, departures_of, estimate_of_largest)},
      {"scale_factor_asymmetry_ppm",
       "Scale factor asymmetry",
       "ppm",
       "12.9",
       "2 (K+ - K-) / (K+ + K-) of the slopes over the rates >= 0 and "
       "<= 0; of the table where it is largest.",
       {kRateTable},
       given(largest_of_tables, asymmetry_of, estimate_of_largest_signed)},
      {"scale_factor_temperature_sensitivity_ppm_per_K",
       "Scale factor sensitivity to temperature",
       "ppm/K",
       "12.9",
       "Slope of the least-squares line of K_j over the measured "
       "temperature T_j, divided by the line at 25 degC.",
       {kRateTable},
       scale_factor_temperature_sensitivity},
      {"scale_factor_retained", "Scale factor retained", "1", "",
       "Slope of the judged rate over the true rate divided by that of "
       "the recorded rate, on the same samples; each run counts by the power "
       "of its true rate.",
       turning_purposes(), given(retained, kEveryRate), 1.0},
      {"scale_factor_retained_small_rates",
       "Scale factor retained at small rates", "1", "",
       "scale_factor_retained over samples whose true rate is within 2 deg/s.",
       turning_purposes(), given(retained, kSmallRate), 1.0},
  };
}

}  // namespace beamgyro::internal
