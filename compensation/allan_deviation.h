// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "compensation/sample_ranges.h"
#include "dataset/recording.h"

namespace beamgyro {

struct AllanPoint {
  double tau;            // [s]
  double deviation;      // [deg/s], or whatever unit the rates have
  std::size_t clusters;  // floor(N / m), averages that do not overlap
};

/// 1-sigma uncertainty of a deviation over the deviation [-]:
/// 1 / sqrt(2 (clusters - 1)).
double relative_uncertainty(const AllanPoint& point);

/// m = 1, 2, 4, ... samples [s] as long as `samples` hold two clusters.
std::vector<double> octave_taus(std::size_t samples, double interval);

/// Plain Allan deviation of N rates y_k taken every `interval` tau_0 [s] (IEEE
/// 952, NIST SP 1065 for frequency data), tau = m tau_0, over the averages Y_i
/// of the M = floor(N / m) clusters that do not overlap:
///
///   sigma^2(tau) = Σ_{i=1}^{M-1} (Y_{i+1} - Y_i)^2 / (2 (M - 1))
///
/// Throws std::invalid_argument for a rate that is not finite (with its index),
/// fewer than two rates, an interval that is not positive, or a tau that is no
/// multiple of the interval to 1e-6 or leaves fewer than two clusters.
std::vector<AllanPoint> adev(std::span<const double> rates, double interval,
                             std::span<const double> taus);

/// Overlapping Allan deviation, from the angles x_k = tau_0 Σ_{j<k} y_j:
///
///   sigma^2(tau) = Σ_{k=0}^{N-2m} (x_{k+2m} - 2 x_{k+m} + x_k)^2
///                  / (2 tau^2 (N - 2m + 1))
///
/// Throws as adev().
std::vector<AllanPoint> oadev(std::span<const double> rates, double interval,
                              std::span<const double> taus);

/// The longest stretch that is powered, finite in `values` (one per time) and
/// without a step in time of more than 1.5 times the usual one; empty when
/// there is none. An Allan deviation needs even steps, and joining stretches
/// would put jumps into it.
SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values);

/// Rates at even steps without a hole.
struct GaplessSeries {
  std::vector<double> rates;  // [deg/s]
  double interval = 0.0;      // [s], the mean step
  double start = 0.0;         // [s]
  std::size_t left_out = 0;   // samples of the recording not in `rates`
};

/// The column `name` over its longest_gapless_range(). Throws
/// std::invalid_argument when there is no such column or no two samples.
GaplessSeries longest_gapless_series(const Recording& recording,
                                     std::string_view name);

/// {"adev": [{"tau_s", "deviation", "clusters"}, ...], "oadev": [...]}
nlohmann::ordered_json to_json(const std::vector<AllanPoint>& plain,
                               const std::vector<AllanPoint>& overlapping);

}  // namespace beamgyro
