// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "compensation/inputs/sample_ranges.h"
#include "compensation/scoring/deviation_kind.h"
#include "compensation/scoring/equivalent_freedom.h"
#include "compensation/scoring/even_series.h"
#include "compensation/scoring/noise_type.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

struct AllanPoint {
  double tau;            // [s]
  double deviation;      // [deg/s], or whatever unit the rates have
  std::size_t clusters;  // one more than neighbouring averages that share none
  double gap_noise = 1.0;  // [-], variance as measured over that without gaps
  // Of the square of the deviation, for that type of noise.
  double freedom = 0.0;
  NoiseType noise = NoiseType::kWhite;
  ConfidenceInterval interval{};  // of 95 %
};

/// Returns the relative 1-sigma uncertainty of a deviation [-]: gap_noise /
/// sqrt(2 (clusters - 1)).
double relative_uncertainty(const AllanPoint& point);

/// m = 1, 2, 4, 8, ...; 1, 2, 4, 10, 20, 40, 100, ...; 1, 2, 3, 4, ...
enum class TauSpacing { kOctave, kDecade, kAll };

/// "octave", "decade", "all", in the order of TauSpacing.
const std::vector<std::string>& tau_spacing_names();

/// Returns the taus [s] of m samples, as long as there are two clusters in the
/// longest stretch.
std::vector<double> taus_of(const EvenSeries& series, TauSpacing spacing);

/// The taus of octaves: of so many samples, of the longest stretch.
std::vector<double> octave_taus(std::size_t samples, double interval);
std::vector<double> octave_taus(const EvenSeries& series);

struct DeviationSeries {
  DeviationKind kind;
  std::vector<AllanPoint> points;
};

/// Both Allan deviations at the same taus.
struct AllanCurve {
  std::vector<AllanPoint> plain, overlapping;
};

/// Returns the deviations of rates y_k sampled every tau_0 (IEEE 952, NIST SP
/// 1065 for frequency data; deviation_kind.h has their equations). With tau =
/// m tau_0 and the means Y_k of the m samples that start at k, that of Allan is
///
///   sigma^2(tau) = mean_k (Y_{k+m} - Y_k)^2 / 2
///
/// over k = 0, m, 2m, ... of each stretch (plain), over all k (overlapping).
///
/// In a stretch with gaps Y_k is the mean of the n_k samples that are there. A
/// difference counts when all its means have half of their samples or more.
/// Such means are noisier than complete ones, so this is subtracted:
///
///   W mean_k (1/n_k + 1/n_{k+m} - 2/m) / 2,
///
/// W is the variance of white noise that neighbours and next neighbours allow
/// (the lesser of half their mean square differences). The deviations of
/// Hadamard, of three means with the weights 1, -2, 1, are treated alike.
/// `gap_noise` has the size of this. mdev and totdev take each part without a
/// gap as a record of its own. A tau has no point in a curve when there is no
/// difference, and in none when nothing is left of that of Allan.
///
/// The type of noise is that of the averages over tau (noise_type.h). Where
/// these are too few it is that of the longest shorter tau at which they are
/// not; white noise without one. The interval is of chi-squared with the
/// `freedom` that the differences have in such noise (equivalent_freedom.h),
/// times the share of differences that the gaps leave, over gap_noise^2.
/// `advance` hears of each tau when it is done: the share of work, 0 .. 1.
///
/// Throws std::invalid_argument for a tau that is no multiple of the interval
/// to 1e-6 or leaves fewer than two clusters.
std::vector<DeviationSeries> deviation_curves(
    const EvenSeries& series, std::span<const DeviationKind> kinds,
    std::span<const double> taus,
    const std::function<void(double)>& advance = {});

/// Returns adev and oadev of it.
AllanCurve allan_curve(const EvenSeries& series, std::span<const double> taus);

/// Of rates without a gap, sampled every `interval` [s]. Also throws
/// std::invalid_argument for a rate that is not finite (with its index), fewer
/// than two rates, or an interval that is not positive.
AllanCurve allan_curve(std::span<const double> rates, double interval,
                       std::span<const double> taus);

/// Returns the ranges of samples that are powered, finite in `values` (one per
/// time) and without a gap.
std::vector<SampleRange> gapless_ranges(const Recording& recording,
                                        std::span<const double> values);

/// Returns the first of the longest of them. It is empty when there is none.
SampleRange longest_gapless_range(const Recording& recording,
                                  std::span<const double> values);

/// {"adev": [{"tau_s", "deviation", "clusters", "interval": [low, high],
/// "freedom", "noise"}, ...], "oadev": [...]}
nlohmann::ordered_json to_json(const std::vector<DeviationSeries>& curves);

}  // namespace beamgyro::internal
