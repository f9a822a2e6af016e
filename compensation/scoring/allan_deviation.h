// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/even_series.h"
#include "dataset/recording/recording.h"

namespace beamgyro {

struct AllanPoint {
  double tau;            // [s]
  double deviation;      // [deg/s], or whatever unit the rates have
  std::size_t clusters;  // one more than neighbouring averages that share none
  double gap_noise = 1.0;  // [-], variance as measured over that without gaps
};

/// Returns the relative 1-sigma uncertainty of a deviation [-]: gap_noise /
/// sqrt(2 (clusters - 1)).
double relative_uncertainty(const AllanPoint& point);

/// Returns the taus [s] of m = 1, 2, 4, ... samples, as long as there are two
/// clusters.
std::vector<double> octave_taus(std::size_t samples, double interval);
/// The same for the longest stretch.
std::vector<double> octave_taus(const EvenSeries& series);

/// Both Allan deviations at the same taus.
struct AllanCurve {
  std::vector<AllanPoint> plain, overlapping;
};

/// Returns the Allan deviations of rates y_k sampled every tau_0 (IEEE 952,
/// NIST SP 1065 for frequency data). With tau = m tau_0 and the means Y_k of
/// the m samples that start at k:
///
///   sigma^2(tau) = mean_k (Y_{k+m} - Y_k)^2 / 2
///
/// over k = 0, m, 2m, ... of each stretch (plain), over all k (overlapping).
///
/// In a stretch with gaps Y_k is the mean of the n_k samples that are there. A
/// difference counts when both means have half of their samples or more. Such
/// means are noisier than complete ones, so this is subtracted:
///
///   W mean_k (1/n_k + 1/n_{k+m} - 2/m) / 2,
///
/// W is the variance of white noise that neighbours and next neighbours allow
/// (the lesser of half their mean square differences). `gap_noise` has its
/// size. A tau has no point when there is no difference, or when nothing is
/// left.
///
/// Throws std::invalid_argument for a tau that is no multiple of the interval
/// to 1e-6 or leaves fewer than two clusters.
AllanCurve allan_curve(const EvenSeries& series, std::span<const double> taus);

/// Return the plain and the overlapping deviation of rates without a gap,
/// sampled every `interval` [s]. Both also throw std::invalid_argument for a
/// rate that is not finite (with its index), fewer than two rates, or an
/// interval that is not positive.
std::vector<AllanPoint> adev(std::span<const double> rates, double interval,
                             std::span<const double> taus);
std::vector<AllanPoint> oadev(std::span<const double> rates, double interval,
                              std::span<const double> taus);

/// Returns the longest range of samples that is powered, finite in `values`
/// (one per time) and without a gap. It is empty when there is none.
SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values);

/// {"adev": [{"tau_s", "deviation", "clusters"}, ...], "oadev": [...]}
nlohmann::ordered_json to_json(const AllanCurve& curve);

}  // namespace beamgyro
