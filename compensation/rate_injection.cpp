// SPDX-License-Identifier: MIT
#include "compensation/rate_injection.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "compensation/sample_ranges.h"

namespace beamgyro {
namespace {

constexpr double kSinePeriod = 20.0;     // [s]
constexpr double kLineTolerance = 1e-6;  // [-], of the span of the output
constexpr double kLeastSpan = 1e-9;      // [deg/s]

std::vector<double>& values_of(Recording& recording, std::string_view name) {
  const auto found = std::ranges::find(recording.columns, name, &Column::name);
  return found->values;
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
  if (low == rate.size() || !(rate[high] - rate[low] > kLeastSpan)) {
    return std::nullopt;
  }
  const double span = output[high] - output[low];
  const double scale = span / (rate[high] - rate[low]);
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      const double line = output[low] + scale * (rate[k] - rate[low]);
      if (!(std::abs(output[k] - line) <=
            kLineTolerance * std::max(std::abs(span), std::abs(line)))) {
        throw std::invalid_argument(fmt::format(
            "output: {} V at {} s is not on the straight line over rate, must "
            "be rate times the nominal scale factor plus the offset",
            output[k], recording.time[k]));
      }
    }
  }
  return scale;
}

std::vector<double> injection_of(const Recording& recording, double amplitude) {
  const auto& time = recording.time;
  std::vector<double> injected(time.size());
  const double length =
      time.empty() ? 0.0 : time.back() - time.front() + usual_step(recording);
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double since = time[k] - time.front();
    injected[k] =
        injected_rate(length > 0.0 ? since / length : 0.0, since, amplitude);
  }
  return injected;
}

}  // namespace

double injected_rate(double fraction, double time, double amplitude) {
  if (fraction < 0.3) {
    return amplitude;
  }
  if (fraction < 0.6) {
    return -amplitude;
  }
  if (fraction < 0.8) {
    return amplitude * std::sin(2.0 * std::numbers::pi * time / kSinePeriod);
  }
  return amplitude * (10.0 * (fraction - 0.8) - 1.0);
}

std::optional<Recording> with_injected_rate(const Recording& recording,
                                            double amplitude) {
  column_values(recording, "rate");
  std::optional<double> scale;
  if (find_column(recording, "output") != nullptr) {
    scale = output_scale(recording);
    if (!scale) {
      return std::nullopt;
    }
  }
  const std::vector<double> injected = injection_of(recording, amplitude);
  Recording moved = recording;
  auto& rate = values_of(moved, "rate");
  for (std::size_t k = 0; k < injected.size(); ++k) {
    rate[k] += injected[k];
  }
  if (scale) {
    auto& output = values_of(moved, "output");
    for (std::size_t k = 0; k < injected.size(); ++k) {
      output[k] += *scale * injected[k];
    }
  }
  return moved;
}

std::optional<double> injected_scale_factor(const RateEstimator& estimator,
                                            const Recording& recording,
                                            double amplitude) {
  const auto moved = with_injected_rate(recording, amplitude);
  if (!moved) {
    return std::nullopt;
  }
  const std::vector<double> injected = injection_of(recording, amplitude);
  const std::vector<double> without = estimator(recording);
  const std::vector<double> with = estimator(*moved);
  double mean = 0.0;
  double samples = 0.0;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      mean += injected[k];
      samples += 1.0;
    }
  }
  mean /= samples;
  double variance = 0.0;
  double covariance = 0.0;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      variance += (injected[k] - mean) * injected[k];
      covariance += (injected[k] - mean) * (with[k] - without[k]);
    }
  }
  return variance > 0.0 ? std::optional(covariance / variance) : std::nullopt;
}

}  // namespace beamgyro
