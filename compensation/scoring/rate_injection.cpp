// SPDX-License-Identifier: MIT
#include "compensation/scoring/rate_injection.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/scale_factor.h"
#include "dataset/recording/stated_values.h"
#include "random/random_stream.h"

namespace beamgyro::internal {
namespace {

constexpr double kDecades = 4.0;         // of the injected rates
constexpr double kHiddenSpread = 0.016;  // [-], of a turn
constexpr double kShortHold = 4.0;       // [s]
constexpr double kLongHold = 600.0;      // [s]
constexpr double kReplayBlock = 1.0;     // [s]
constexpr double kBeyond = 1.01;         // [-], of full scale
constexpr double kLineTolerance = 1e-6;  // [-], of the span of the output
constexpr double kLeastRateSpan = 1e-9;  // [deg/s]
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<double>& values_of(Recording& recording, std::string_view name) {
  const auto found = std::ranges::find(recording.columns, name, &Column::name);
  return found->values;
}

/// Returns the recording without its truth, which an estimator must not use and
/// which is the larger part of a long run.
Recording measured_part(const Recording& recording) {
  Recording part;
  part.time = recording.time;
  part.status = recording.status;
  std::ranges::copy_if(
      recording.columns, std::back_inserter(part.columns),
      [](const Column& column) { return column.role == Role::kMeasured; });
  return part;
}

/// S [V/(deg/s)] of output = offset + S rate.
std::optional<double> output_scale(const Recording& recording) {
  const auto& output = column_values(recording, "output");
  const auto& rate = column_values(recording, "rate");
  std::size_t low = rate.size();
  std::size_t high = rate.size();
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      low = low == rate.size() || rate[k] < rate[low] ? k : low;
      high = high == rate.size() || rate[k] > rate[high] ? k : high;
    }
  }
  if (low == rate.size() || !(rate[high] - rate[low] > kLeastRateSpan))
    return std::nullopt;
  const double span = output[high] - output[low];
  const double scale = span / (rate[high] - rate[low]);
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const double line = output[low] + scale * (rate[k] - rate[low]);
      if (!(std::abs(output[k] - line) <=
            kLineTolerance * std::max(std::abs(span), std::abs(line))))
        throw std::invalid_argument(fmt::format(
            "output: {} V at {} s is not on the straight line over rate, must "
            "be rate times the nominal scale factor plus the offset",
            output[k], recording.time[k]));
    }
  }
  return scale;
}

/// Rates held in turn over a recording.
struct Injection {
  std::vector<double> rate;   // [deg/s], one per time
  std::vector<double> since;  // [s], the step to it
};

Injection injection_of(const Recording& recording, double hold, double largest,
                       std::size_t first_hold) {
  // Half a step keeps a sample in its hold however the time was rounded.
  const double origin = recording.time.front() - 0.5 * usual_step(recording);
  const std::uint64_t hidden = hidden_number(recording);
  Injection injection;
  double number = -1.0;
  double rate = 0.0;
  for (const double time : recording.time) {
    const double here = std::floor((time - origin) / hold);
    if (here != number) {
      number = here;
      rate = held_rate(first_hold + static_cast<std::size_t>(number), largest,
                       hidden);
    }
    injection.rate.push_back(rate);
    injection.since.push_back(time - origin - number * hold);
  }
  return injection;
}

double value_at(const Column* column, std::size_t k, double without) {
  return column == nullptr ? without : column->values[k];
}

/// Appends the blocks of one replay; `difference` of its answers [deg/s].
void append_blocks(const Recording& recording, const Injection& injection,
                   std::span<const double> difference, double full_scale,
                   double settling, std::vector<ReplayedBlock>& blocks) {
  const Column* temperature = find_column(recording, "temperature");
  const Column* truth = find_column(recording, "true_rate");
  const std::vector<double>& rate = injection.rate;
  const std::vector<double>& since = injection.since;
  const auto number = [&since](std::size_t k) {
    return std::floor(since[k] / kReplayBlock);
  };
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t begin = stretch.begin; begin < stretch.end;) {
      double sum = 0.0;
      double samples = 0.0;
      std::size_t k = begin;
      for (; k < stretch.end && (k == begin || (rate[k] == rate[begin] &&
                                                number(k) == number(begin)));
           ++k) {
        if (since[k] >= settling && std::abs(value_at(truth, k, 0.0) +
                                             rate[k]) <= kBeyond * full_scale) {
          sum += difference[k];
          samples += 1.0;
        }
      }
      if (samples > 0.0 && rate[begin] != 0.0)
        blocks.push_back({recording.time[begin],
                          value_at(temperature, begin, kNone), rate[begin],
                          sum / (samples * rate[begin])});
      begin = k;
    }
  }
}

}  // namespace

std::optional<double> stated_full_scale(const Recording& recording) {
  const std::optional<double> stated =
      stated_device_number(recording, "readout.full_scale_deg_per_s");
  return stated > 0.0 && std::isfinite(*stated) ? stated : std::nullopt;
}

std::uint64_t hidden_number(const Recording& recording) {
  const auto& rate = column_values(recording, "rate");
  std::uint64_t hidden = 0;
  for (const SampleRange& stretch : powered_stretches(recording))
    for (std::size_t k = stretch.begin; k < stretch.end; ++k)
      hidden = (std::rotl(hidden, 7) ^ std::bit_cast<std::uint64_t>(rate[k])) *
               0x9E3779B97F4A7C15;
  return hidden ^ (hidden >> 32);
}

double held_rate(std::size_t hold, double largest, std::uint64_t hidden) {
  if (hold == 0) return largest;
  const auto number = [hidden](std::size_t k) {
    return RandomStream(hidden, 0, static_cast<std::uint32_t>(k),
                        kRateProfileStream)
        .uniform();
  };
  const double turns = static_cast<double>(hold) * (std::numbers::phi - 1.0) +
                       number(0) + kHiddenSpread * (number(hold) - 0.5);
  const double size =
      largest * std::pow(10.0, -kDecades * (turns - std::floor(turns)));
  return hold % 2 == 0 ? size : -size;
}

std::optional<Recording> with_injected_rate(const Recording& recording,
                                            std::span<const double> injected) {
  Recording moved = measured_part(recording);
  column_values(moved, "rate");
  std::optional<double> scale;
  if (find_column(moved, "output") != nullptr) {
    scale = output_scale(moved);
    if (!scale) return std::nullopt;
  }
  auto& rate = values_of(moved, "rate");
  for (std::size_t k = 0; k < injected.size(); ++k) rate[k] += injected[k];
  if (scale) {
    auto& output = values_of(moved, "output");
    for (std::size_t k = 0; k < injected.size(); ++k)
      output[k] += *scale * injected[k];
  }
  return moved;
}

void quieten(const Recording& recording, double quiet,
             std::vector<double>& added) {
  if (quiet <= 0.0) return;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    const double begin = recording.time[stretch.begin];
    for (std::size_t k = stretch.begin;
         k < stretch.end && recording.time[k] - begin <= quiet; ++k) {
      added[k] = 0.0;
    }
  }
}

std::optional<std::vector<ReplayedBlock>> replay(
    const RateEstimator& estimator, const Recording& recording,
    std::span<const double> answers, double full_scale, std::size_t first_hold,
    const ReplayPauses& pauses) {
  const std::size_t samples = recording.time.size();
  if (samples == 0) return std::nullopt;
  const double step = usual_step(recording);
  const double length = recording.time.back() - recording.time.front() + step;
  const double short_hold =
      std::max({kShortHold, 4.0 * step, 2.0 * pauses.settling});
  const double long_hold =
      std::max(short_hold, std::min(kLongHold, 0.25 * length));
  std::vector<ReplayedBlock> blocks;
  for (const double hold : {short_hold, long_hold}) {
    Injection injection = injection_of(recording, hold, full_scale, first_hold);
    quieten(recording, pauses.quiet, injection.rate);
    const auto moved = with_injected_rate(recording, injection.rate);
    if (!moved) return std::nullopt;
    std::vector<double> difference = estimator(*moved);
    for (std::size_t k = 0; k < samples; ++k) difference[k] -= answers[k];
    append_blocks(recording, injection, difference, full_scale, pauses.settling,
                  blocks);
  }
  return blocks;
}

}  // namespace beamgyro::internal
