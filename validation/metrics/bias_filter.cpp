// SPDX-License-Identifier: MIT
#include "validation/metrics/bias_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "validation/metrics/rate_noise_model.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {
namespace {

// What the filter reads of a run.
struct FilterInput {
  const Recording& recording;
  const std::vector<double>& sigma;        // [deg/s]
  const std::vector<double>& temperature;  // [degC]
  std::vector<double> residual;            // [deg/s]
  double white;                            // N [deg/s/sqrt(Hz)]
  double step;                             // [s]

  bool can_be_read(std::size_t k) const {
    return (recording.status[k] & kLoopNotLocked) == 0 &&
           std::isfinite(residual[k]) && std::isfinite(temperature[k]) &&
           sigma[k] > 0.0;
  }
};

// Returns the end of the samples of a measurement that starts at `begin`, or
// nothing where one of them cannot be read.
std::optional<std::size_t> end_of_measurement(const FilterInput& in,
                                              std::size_t begin,
                                              std::size_t end) {
  const double until =
      in.recording.time[begin] + kFilterAverage - 0.5 * in.step;
  std::size_t k = begin;
  do {
    if (!in.can_be_read(k)) return std::nullopt;
    ++k;
  } while (k < end && in.recording.time[k] < until);
  return k;
}

Innovation measured(const FilterInput& in, SampleRange range,
                    BiasFilter& filter) {
  const auto count = static_cast<double>(range.size());
  return filter.measure(
      mean_of(std::span(in.residual).subspan(range.begin, range.size())),
      in.white * in.white / (count * in.step));
}

void add_innovations(const FilterInput& in, const SampleRange& stretch,
                     std::vector<Innovation>& innovations) {
  std::optional<BiasFilter> filter;
  double last = 0.0;  // [degC], of the last measurement
  for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
    if (filter && !(std::abs(in.temperature[k] - last) >= kFilterStep))
      continue;
    const auto end = end_of_measurement(in, k, stretch.end);
    if (!end) continue;
    if (filter)
      filter->predict(in.sigma[k], in.temperature[k]);
    else
      filter.emplace(in.sigma[k], in.temperature[k]);
    last = in.temperature[k];
    innovations.push_back(measured(in, {k, *end}, *filter));
  }
}

}  // namespace

BiasFilter::BiasFilter(double sigma, double temperature)
    : sigma_(sigma), temperature_(temperature), variance_(sigma * sigma) {}

void BiasFilter::predict(double sigma, double temperature) {
  const auto [carried, variance] =
      bias_step(sigma_, sigma, temperature - temperature_);
  bias_ *= carried;
  variance_ = carried * carried * variance_ + variance;
  sigma_ = sigma;
  temperature_ = temperature;
}

Innovation BiasFilter::measure(double error, double variance) {
  const double innovation = error - bias_;
  const double expected = variance_ + variance;
  bias_ += variance_ * innovation / expected;
  variance_ *= variance / expected;
  return {innovation * innovation, expected};
}

std::vector<Innovation> filter_innovations(const EvidenceRun& run) {
  std::vector<double> residual = residual_of(run);
  const double white = seen_noise(*run.recording, residual).angle_random_walk;
  const FilterInput in{*run.recording,
                       run.sigma,
                       column_values(*run.recording, "temperature"),
                       std::move(residual),
                       white,
                       usual_step(*run.recording)};
  std::vector<Innovation> innovations;
  for (const SampleRange& stretch : powered_stretches(*run.recording))
    add_innovations(in, stretch, innovations);
  return innovations;
}

}  // namespace beamgyro::internal
