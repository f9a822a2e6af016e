// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

/// Response at one frequency.
struct ResponsePoint {
  double frequency;           // [Hz]
  std::complex<double> gain;  // output over input; falling argument: a lag
  double sigma;               // 1-sigma of each part of the gain
  double freedom;             // degrees of freedom of sigma
};

/// Returns the response of `output` to `input` in a sine run. The frequency is
/// that at which true_rate passes its middle. Both are fitted by a sine beside
/// a straight line, over the last whole periods from kSettlingTime after
/// power-on. The noise at the frequency is taken from its neighbours k/T, k = 2
/// ... 6, where T is the length of the fit. Returns nothing for less than a
/// period.
std::optional<ResponsePoint> sine_response(const Recording& recording,
                                           std::span<const double> input,
                                           std::span<const double> output);

/// Returns the responses of the judged rate to a column of the sine runs, by
/// rising frequency.
std::vector<ResponsePoint> sine_responses(const Evidence& evidence,
                                          std::string_view input);

/// Returns the response of `output` to the first step of true_rate that comes
/// kLeastRest [s] or more after the power-on, at `frequencies` [Hz]:
///
///   H(f) = sum_k (y_{k+1} - y_k) e^(-2 pi i f (t_k + dt/2 - t_0)) / (y_end -
///   y_0),
///
/// corrected for the step dt. The noise is that before the step. Returns
/// nothing without such a step.
std::vector<ResponsePoint> step_response(const Recording& recording,
                                         std::span<const double> output,
                                         std::span<const double> frequencies);

/// Returns the responses of the judged rate to the true rate, by rising
/// frequency: those of the sine runs, and those of the first step from there on
/// up to the Nyquist frequency.
std::vector<ResponsePoint> response_to_true_rate(const Evidence& evidence);

/// Where a quantity falls below a level: the frequency, and its 1-sigma.
struct Crossing {
  double frequency, sigma, freedom;
};

/// Returns the first crossing of level zero by `values`, which have the
/// standard deviations `sigmas`, one for each point, and `common_sigma`, of
/// what they share, linear over the logarithm of the frequency. Returns nothing
/// when there is none.
std::optional<Crossing> first_crossing(std::span<const ResponsePoint> points,
                                       std::span<const double> values,
                                       std::span<const double> sigmas,
                                       double common_sigma);

}  // namespace beamgyro::internal
