// SPDX-License-Identifier: MIT
#include "validation/evidence/recorded_purpose.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

namespace beamgyro::internal {
namespace {

constexpr double kLongHold = 300.0;  // [s]

// The values at which a signal is held, and for how long at most.
struct Holds {
  double share = 0.0;       // of the samples, that are held
  std::set<double> values;  // at which it is held
  double longest = 0.0;     // [s]
};

// A hold is a piece of three equal samples or more.
Holds holds_of(const std::vector<double>& time,
               const std::vector<double>& signal) {
  constexpr std::size_t kFewest = 3;
  Holds holds;
  std::size_t held = 0;
  for (std::size_t k = 0; k < signal.size();) {
    std::size_t end = k + 1;
    while (end < signal.size() && signal[end] == signal[k]) ++end;
    if (end - k >= kFewest) {
      held += end - k;
      holds.values.insert(signal[k]);
      if (signal[k] != 0.0)
        holds.longest = std::max(holds.longest, time[end - 1] - time[k]);
    }
    k = end;
  }
  holds.share = static_cast<double>(held) / static_cast<double>(signal.size());
  return holds;
}

bool is_held(const Holds& holds) { return holds.share > 0.9; }

bool is_zero(const Column* column) {
  return column == nullptr ||
         std::ranges::all_of(column->values,
                             [](double value) { return value == 0.0; });
}

// Evenly sampled, x[k-1] + x[k+1] = 2 cos(w dt) x[k] about its mean.
bool is_sine(const std::vector<double>& signal) {
  if (signal.size() < 8) return false;
  const auto [low, high] = std::ranges::minmax(signal);
  const double mean = 0.5 * (low + high), amplitude = 0.5 * (high - low);
  double products = 0.0, squares = 0.0;
  for (std::size_t k = 1; k + 1 < signal.size(); ++k) {
    const double x = signal[k] - mean;
    products += x * (signal[k - 1] + signal[k + 1] - 2 * mean);
    squares += x * x;
  }
  const double factor = products / squares;
  std::size_t departures = 0;
  for (std::size_t k = 1; k + 1 < signal.size(); ++k)
    departures += std::abs(signal[k - 1] + signal[k + 1] - 2 * mean -
                           factor * (signal[k] - mean)) > 0.02 * amplitude;
  return departures * 50 < signal.size();
}

RunPurpose purpose_of_rate(const Recording& recording,
                           const std::vector<double>& rate) {
  const Holds holds = holds_of(recording.time, rate);
  if (!is_held(holds))
    return is_sine(rate) ? RunPurpose::kSineRate : RunPurpose::kRandomRate;
  const std::size_t values = holds.values.size();
  const bool is_long = holds.longest >= kLongHold;
  if (values >= 7 || (values >= 5 && !is_long)) return RunPurpose::kRateTable;
  return is_long ? RunPurpose::kConstantRate : RunPurpose::kRateStep;
}

std::size_t power_on_count(const Recording& recording) {
  std::size_t count = 0;
  bool was_on = false;
  for (const std::uint8_t status : recording.status) {
    const bool is_on = (status & kUnpowered) == 0;
    count += is_on && !was_on;
    was_on = is_on;
  }
  return count;
}

RunPurpose purpose_at_constant_ambient(const Recording& recording) {
  constexpr double kLeastRest = 1800.0;  // [s]
  return recording.time.back() - recording.time.front() >
                 kRestBegins + kLeastRest
             ? RunPurpose::kRest
             : RunPurpose::kWarmUp;
}

RunPurpose purpose_at_rest(const Recording& recording) {
  if (power_on_count(recording) > 1) return RunPurpose::kPowerCycle;
  if (const Column* ambient =
          find_column(recording, "true_ambient_temperature")) {
    const Holds holds = holds_of(recording.time, ambient->values);
    if (holds.values.size() == 1 && holds.share == 1.0)
      return purpose_at_constant_ambient(recording);
    return holds.values.size() >= 3 ? RunPurpose::kSoak : RunPurpose::kRamp;
  }
  const Column* measured = find_column(recording, "temperature");
  if (measured == nullptr) return purpose_at_constant_ambient(recording);
  constexpr double kOneTemperature = 8.0;  // [K], self-heating and noise
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : measured->values) {  // NaN while unpowered
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
  return high - low < kOneTemperature ? purpose_at_constant_ambient(recording)
                                      : RunPurpose::kRamp;
}

}  // namespace

RunPurpose recorded_purpose(const Recording& recording) {
  const std::vector<double>& rate = column_values(recording, "true_rate");
  if (std::ranges::any_of(rate, [](double value) { return value != 0.0; }))
    return purpose_of_rate(recording, rate);
  bool moves = false, is_tumble = true;
  for (const Column& column : recording.columns) {
    const bool is_acceleration = column.name.starts_with("true_acceleration_");
    if ((!is_acceleration && !column.name.starts_with("true_cross_rate_")) ||
        is_zero(&column))
      continue;
    moves = true;
    is_tumble = is_tumble && is_acceleration &&
                is_held(holds_of(recording.time, column.values));
  }
  if (moves) return is_tumble ? RunPurpose::kTumble : RunPurpose::kVibration;
  return purpose_at_rest(recording);
}

}  // namespace beamgyro::internal
