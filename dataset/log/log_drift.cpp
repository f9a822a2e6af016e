// SPDX-License-Identifier: MIT
#include "dataset/log/log_drift.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dataset/log/log_statistics.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kLeastSpan = 10.0;    // [K]
constexpr double kLeastTotal = 5.0;    // [K]
constexpr double kLeastShare = 0.25;   // of all changes
constexpr double kLeastChange = 0.5;   // [K]
constexpr double kLeastSteps = 3.0;    // of the smallest between two rows
constexpr double kCoarsestStep = 1.0;  // [K] of a thermometer
constexpr double kLeastNoise = 10.0;   // standard deviations

// Medians over five values, over three at both ends.
std::vector<double> smoothed_by_medians(const std::vector<double>& values) {
  const std::size_t count = values.size();
  std::vector<double> smooth(count), near;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t half = std::min(k, count - 1 - k) < 2 ? 1 : 2;
    const std::size_t size = std::min(2 * half + 1, count);
    const std::size_t first = std::min(std::max(k, half) - half, count - size);
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    near.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
    smooth[k] = median_of(near);
  }
  return smooth;
}

// The least change that is neither noise nor a step of a coarse thermometer.
double least_change(const std::vector<double>& values,
                    const std::vector<double>& smooth) {
  std::vector<double> rest(values.size());
  for (std::size_t k = 0; k < rest.size(); ++k)
    rest[k] = std::abs(values[k] - smooth[k]);
  return std::max({kLeastChange,
                   kLeastSteps * std::min(smallest_step(values), kCoarsestStep),
                   kLeastNoise * kSigmaPerMad * median_of(rest)});
}

// Whether the change over the rows begin .. end is one step between rows that
// do not change: where logs of several soaks were joined.
bool is_lone_step(const std::vector<double>& smooth, std::size_t begin,
                  std::size_t end) {
  constexpr double kWhole = 0.9, kStill = 0.1;  // of the change, of the step
  const auto step = [&](std::size_t k) {
    return k == 0 || k == smooth.size() ? 0.0
                                        : std::abs(smooth[k] - smooth[k - 1]);
  };
  std::size_t at = begin + 1;
  for (std::size_t k = at; k <= end; ++k)
    if (step(k) > step(at)) at = k;
  return step(at) >= kWhole * std::abs(smooth[end] - smooth[begin]) &&
         std::max(step(at - 1), step(at + 1)) < kStill * step(at);
}

constexpr double kYear = 365.25 * 86400;  // [s]
constexpr double kLongestLog = 5;         // [years]

// What the next longer or shorter unit of time would make of a duration [s].
std::string other_unit(const LogTime& time, double duration, bool longer) {
  constexpr std::array kUnits = {"ns", "us", "ms", "s", "min", "h"};
  const auto unit = std::find(kUnits.begin(), kUnits.end(), time.unit);
  if (unit == kUnits.end() ||
      (longer ? unit + 1 == kUnits.end() : unit == kUnits.begin()))
    return time.place;
  const char* const other = *(longer ? unit + 1 : unit - 1);
  const double ratio =
      unit_conversion(other, "s").scale / unit_conversion(time.unit, "s").scale;
  return fmt::format("{} = \"{}\", \"{}\" makes it {:.6g} s", time.place,
                     time.unit, other, ratio * duration);
}

double duration_of(const Recording& recording) {
  return recording.time.back() - recording.time.front();
}

void check_duration(const Recording& recording,
                    const std::vector<std::size_t>& lines, const LogMap& map,
                    const std::string& path) {
  const double duration = duration_of(recording);
  if (duration <= kLongestLog * kYear) return;
  const std::vector<double>& time = recording.time;
  std::size_t k = 1;  // the row after the longest step
  for (std::size_t i = 2; i < time.size(); ++i)
    if (time[i] - time[i - 1] > time[k] - time[k - 1]) k = i;
  const double step = time[k] - time[k - 1];
  throw std::invalid_argument(fmt::format(
      "{}: lasts {:.3g} years; expected at most {:g} years: look at {}{}", path,
      duration / kYear, kLongestLog, other_unit(map.time, duration, false),
      step < duration / 2
          ? ""
          : fmt::format(", or leave out the rows from before the clock was set "
                        "(time.from in the map): line {} comes {:.3g} s after "
                        "line {}",
                        lines[k], step, lines[k - 1])));
}

}  // namespace

std::optional<FastDrift> fast_drift(std::span<const double> time,
                                    std::span<const double> temperature) {
  std::vector<std::size_t> rows;
  std::vector<double> values;
  for (std::size_t k = 0; k < temperature.size(); ++k) {
    if (!std::isfinite(temperature[k])) continue;
    rows.push_back(k);
    values.push_back(temperature[k]);
  }
  if (values.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high - *low < kLeastSpan) return std::nullopt;
  const std::vector<double> smooth = smoothed_by_medians(values);
  const double least = least_change(values, smooth);
  const bool may_be_joined =
      *high - *low <= kFastestDrift * (time[rows.back()] - time[rows.front()]);
  FastDrift fast{0, 0, 1, 0};
  double all = 0.0, reached = smooth.front();
  std::size_t begin = 0;  // of the stretch that ends at row k
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::abs(smooth[k] - reached) >= least) {
      all += std::abs(smooth[k] - reached);
      reached = smooth[k];
    }
    const auto elapsed = [&] { return time[rows[k]] - time[rows[begin]]; };
    while (begin + 1 < k && kFastestDrift * elapsed() >= least) ++begin;
    const double change = std::abs(smooth[k] - smooth[begin]);
    if (change < least || change <= kFastestDrift * elapsed()) continue;
    if (may_be_joined && is_lone_step(smooth, begin, k)) {
      begin = k;
      continue;
    }
    fast.total += change;
    if (change * fast.elapsed > fast.change * elapsed())
      fast = {rows[k], change, elapsed(), fast.total};
    begin = k;
  }
  if (fast.total < kLeastTotal || fast.total < kLeastShare * all)
    return std::nullopt;
  return fast;
}

void check_time_unit(const Recording& recording,
                     const std::vector<std::size_t>& lines, const LogMap& map,
                     const std::string& path) {
  check_duration(recording, lines, map, path);
  const Column* const temperature = find_column(recording, "temperature");
  const bool is_joined = std::any_of(
      map.quantities.begin(), map.quantities.end(), [](const auto& quantity) {
        return quantity.joined && quantity.signal.name == "temperature";
      });
  if (map.rules.keep_fast_temperature || temperature == nullptr || is_joined)
    return;
  const std::optional<FastDrift> fast =
      fast_drift(recording.time, temperature->values);
  if (!fast) return;
  const double duration = duration_of(recording);
  throw std::invalid_argument(fmt::format(
      "{}:{}: the temperature changes by {:.3g} K within {:.3g} s, and by "
      "{:.4g} K at such rates in the {:.3g} s of the log, is that right? "
      "expected at most {:g} K/s: look at {} (or state "
      "rules.fast_temperature = \"keep\" in the map)",
      path, lines[fast->row], fast->change, fast->elapsed, fast->total,
      duration, kFastestDrift, other_unit(map.time, duration, true)));
}

}  // namespace beamgyro::internal
