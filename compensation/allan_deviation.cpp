// SPDX-License-Identifier: MIT
#include "compensation/allan_deviation.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "compensation/sample_ranges.h"

namespace beamgyro {
namespace {

constexpr double kTauTolerance = 1e-6;  // [-]
constexpr double kGap = 1.5;            // [-], usual steps

void require(bool holds, const std::string& message) {
  if (!holds) {
    throw std::invalid_argument(message);
  }
}

/// Angles of the rates less their mean, in steps of the interval: a constant
/// cancels in every second difference, and without it the sums stay small. Long
/// double keeps eleven more bits for records of 1e8 samples.
std::vector<long double> angles(std::span<const double> rates) {
  long double mean = 0.0L;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    require(std::isfinite(rates[k]),
            fmt::format("rate {}: {} is not finite; an Allan deviation needs a "
                        "series without holes",
                        k, rates[k]));
    mean += rates[k];
  }
  mean /= static_cast<long double>(rates.size());
  std::vector<long double> angle(rates.size() + 1, 0.0L);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    angle[k + 1] = angle[k] + (rates[k] - mean);
  }
  return angle;
}

std::size_t samples_of(double tau, double interval, std::size_t samples) {
  const double ratio = tau / interval;
  const double m = std::round(ratio);
  require(m >= 1.0 && std::abs(ratio - m) <= kTauTolerance * ratio,
          fmt::format("tau: {} s, must be a multiple of the interval of {} s",
                      tau, interval));
  require(2.0 * m <= static_cast<double>(samples),
          fmt::format("tau: {} s, must be at most half of the record of {} s",
                      tau, static_cast<double>(samples) * interval));
  return static_cast<std::size_t>(m);
}

/// Both estimators: second differences of the angle, started every `stride`
/// samples.
double deviation(const std::vector<long double>& angle, std::size_t m,
                 std::size_t stride) {
  long double sum = 0.0L;
  std::size_t terms = 0;
  for (std::size_t k = 0; k + 2 * m < angle.size(); k += stride) {
    const long double d = angle[k + 2 * m] - 2.0L * angle[k + m] + angle[k];
    sum += d * d;
    ++terms;
  }
  const auto length = static_cast<long double>(m);
  return static_cast<double>(std::sqrt(
      sum / (2.0L * length * length * static_cast<long double>(terms))));
}

std::vector<AllanPoint> deviations(std::span<const double> rates,
                                   double interval,
                                   std::span<const double> taus,
                                   bool overlapping) {
  require(std::isfinite(interval) && interval > 0.0,
          fmt::format("interval: {} s, must be positive", interval));
  require(rates.size() >= 2,
          fmt::format("rates: {}, must be at least two", rates.size()));
  const std::vector<long double> angle = angles(rates);
  std::vector<AllanPoint> points;
  points.reserve(taus.size());
  for (const double tau : taus) {
    const std::size_t m = samples_of(tau, interval, rates.size());
    points.push_back({static_cast<double>(m) * interval,
                      deviation(angle, m, overlapping ? 1 : m),
                      rates.size() / m});
  }
  return points;
}

nlohmann::ordered_json list(const std::vector<AllanPoint>& points) {
  auto all = nlohmann::ordered_json::array();
  for (const AllanPoint& point : points) {
    all.push_back({{"tau_s", point.tau},
                   {"deviation", point.deviation},
                   {"clusters", point.clusters}});
  }
  return all;
}

}  // namespace

double relative_uncertainty(const AllanPoint& point) {
  return 1.0 / std::sqrt(2.0 * (static_cast<double>(point.clusters) - 1.0));
}

std::vector<double> octave_taus(std::size_t samples, double interval) {
  std::vector<double> taus;
  for (std::size_t m = 1; m <= samples / 2; m *= 2) {
    taus.push_back(static_cast<double>(m) * interval);
  }
  return taus;
}

std::vector<AllanPoint> adev(std::span<const double> rates, double interval,
                             std::span<const double> taus) {
  return deviations(rates, interval, taus, false);
}

std::vector<AllanPoint> oadev(std::span<const double> rates, double interval,
                              std::span<const double> taus) {
  return deviations(rates, interval, taus, true);
}

SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values) {
  const auto& time = recording.time;
  const double longest_step = kGap * usual_step(recording);
  SampleRange longest{0, 0};
  for (const SampleRange& stretch : powered_stretches(recording)) {
    std::size_t begin = stretch.begin;
    for (std::size_t k = stretch.begin; k < stretch.end; ++k) {
      if (!std::isfinite(values[k])) {
        begin = k + 1;
      } else if (k > begin && time[k] - time[k - 1] > longest_step) {
        begin = k;
      }
      if (k + 1 > begin + longest.size()) {
        longest = {begin, k + 1};
      }
    }
  }
  return longest;
}

GaplessSeries longest_gapless_series(const Recording& recording,
                                     std::string_view name) {
  const auto& values = column_values(recording, name);
  const auto& time = recording.time;
  const SampleRange range = longest_gapless_range(recording, values);
  require(range.size() >= 2,
          fmt::format("{}: no two powered samples in a row", name));
  const auto series = std::span(values).subspan(range.begin, range.size());
  return {.rates = {series.begin(), series.end()},
          .interval = (time[range.end - 1] - time[range.begin]) /
                      static_cast<double>(range.size() - 1),
          .start = time[range.begin],
          .left_out = values.size() - range.size()};
}

nlohmann::ordered_json to_json(const std::vector<AllanPoint>& plain,
                               const std::vector<AllanPoint>& overlapping) {
  nlohmann::ordered_json json;
  json["adev"] = list(plain);
  json["oadev"] = list(overlapping);
  return json;
}

}  // namespace beamgyro
