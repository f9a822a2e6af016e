// SPDX-License-Identifier: MIT
#include "compensation/methods/autopilot_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/models/array_view.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr int kCubicDegree = 3;
constexpr Index kMedianSamples = 31;
constexpr int kPx4Bins = 2000;
constexpr double kAveragingTime = 2.0;    // [s]
constexpr double kTemperatureStep = 0.5;  // [K]

// Median over a window cut short at the ends of a power cycle.
ArrayXd median_filtered(const TrainingRows& samples) {
  ArrayXd result(samples.size());
  std::vector<double> window;
  for (const auto& [begin, end] : stretches_of(samples.cycle))
    for (Index k = begin; k < end; ++k) {
      const Index first = std::max(begin, k - kMedianSamples / 2);
      const Index last = std::min(end, k + kMedianSamples / 2 + 1);
      window.assign(samples.bias.begin() + first, samples.bias.begin() + last);
      const auto middle =
          window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2);
      std::nth_element(window.begin(), middle, window.end());
      result(k) = *middle;
    }
  return result;
}

BiasModel cubic_about(double reference, const ArrayXd& temperature,
                      const ArrayXd& bias) {
  // Fitted in half widths, so that the solution is not lost in rounding, and
  // converted to kelvins about the reference, as the parameters are.
  const double half_width =
      std::max((temperature - reference).abs().maxCoeff(), 1e-3);
  Polynomial p = fit_polynomial((temperature - reference) / half_width, bias,
                                kCubicDegree);
  for (std::size_t n = 0; n < p.coefficients.size(); ++n)
    p.coefficients[n] /= std::pow(half_width, n);
  return {{{reference, 1.0}}, {}, p};
}

struct BiasPoints {
  std::vector<double> temperature, bias;
};

// Points of one power cycle.
void add_points(const TrainingRows& samples, Index begin, Index end,
                int least_samples, BiasPoints& points) {
  double start = NAN, sum_T = 0.0, sum_b = 0.0, bias = 0.0;
  int count = 0;
  Index oldest = begin;
  for (Index k = begin; k < end; ++k) {
    sum_T += samples.temperature(k);
    sum_b += samples.bias(k);
    while (samples.time(k) - samples.time(oldest) > kAveragingTime) {
      sum_T -= samples.temperature(oldest);
      sum_b -= samples.bias(oldest);
      ++oldest;
    }
    const double averaged = static_cast<double>(k - oldest + 1);
    const double T = sum_T / averaged;
    if (std::isnan(start)) start = T;
    if (T < start) continue;
    bias += sum_b / averaged;
    ++count;
    if (T - start < kTemperatureStep || count < least_samples) continue;
    points.temperature.push_back(0.5 * (start + T));
    points.bias.push_back(bias / count);
    start = T;
    bias = 0.0;
    count = 0;
  }
}

}  // namespace

BiasModel fit_as_px4(const TrainingRows& samples) {
  const double low = samples.range.lowest, high = samples.range.highest;
  if (!(high > low))
    throw std::invalid_argument(fmt::format(
        "temperature is {} degC throughout; a cubic needs a range", low));
  const ArrayXd bias = median_filtered(samples);
  ArrayXd count = ArrayXd::Zero(kPx4Bins), T = count, b = count;
  for (Index k = 0; k < samples.size(); ++k) {
    const auto bin =
        std::clamp(static_cast<Index>((samples.temperature(k) - low) /
                                      (high - low) * kPx4Bins),
                   Index{0}, Index{kPx4Bins - 1});
    count(bin) += 1.0;
    T(bin) += samples.temperature(k);
    b(bin) += bias(k);
  }
  BiasPoints points;
  for (Index bin = 0; bin < kPx4Bins; ++bin)
    if (count(bin) > 0.0) {
      points.temperature.push_back(T(bin) / count(bin));
      points.bias.push_back(b(bin) / count(bin));
    }
  return cubic_about(0.5 * (low + high), array_view(points.temperature),
                     array_view(points.bias));
}

BiasModel fit_as_ardupilot(const TrainingRows& samples, int least_samples) {
  const double span = samples.range.highest - samples.range.lowest;
  if (span < kArduPilotSpan)
    throw std::invalid_argument(fmt::format(
        "temperature spans {:.2f} K in training; ArduPilot's calibration "
        "needs {} K",
        span, kArduPilotSpan));
  BiasPoints points;
  for (const auto& [begin, end] : stretches_of(samples.cycle))
    add_points(samples, begin, end, least_samples, points);
  if (points.bias.size() <= kCubicDegree)
    throw std::invalid_argument(fmt::format(
        "the temperature rises by {} K over {} samples {} times in training; "
        "ArduPilot's calibration learns while heating and needs {} such rises",
        kTemperatureStep, least_samples, points.bias.size(), kCubicDegree + 1));
  return cubic_about(kArduPilotReference, array_view(points.temperature),
                     array_view(points.bias));
}

Fit Px4Spec::fit(const FitTask& task) const { return fit_as_px4(task.rows); }

ArduPilotSpec ArduPilotSpec::read(MethodSource& source) {
  return {static_cast<int>(
      source.table(kName).integer_or("least_samples", 100, 1, 1000000))};
}

Fit ArduPilotSpec::fit(const FitTask& task) const {
  return fit_as_ardupilot(task.rows, least_samples);
}

}  // namespace beamgyro::internal
