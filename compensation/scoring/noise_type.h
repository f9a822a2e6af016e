// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Noise whose rate has a spectrum that goes with f^exponent.
enum class NoiseType : int {
  kQuantisation = 2,  // white noise of the angle
  kAngleFlicker = 1,
  kWhite = 0,
  kFlicker = -1,
  kRandomWalk = -2,
  kFlickerWalk = -3,
  kRandomRun = -4,
};

std::string_view name_of(NoiseType type);

/// Returns the type of noise that rules neighbouring averages of a rate, after
/// the lag-1 autocorrelation r of Riley and Greenhall (18th EFTF, 2004):
/// with delta = r / (1 + r) the exponent is -2 delta where delta < 1/4; else
/// the averages are differenced, at most twice, and each difference takes 2
/// off. It is rounded. Differences and products do not join stretches; NaN is
/// an average that is not known.
///
/// `shorter` is the type at a shorter tau. With fewer than 100 averages, whose
/// exponent has an uncertainty of 0.2 and more, the type does not rise above
/// it: in records of gyros the exponent falls with tau. With fewer than 30, or
/// averages that do not vary, `shorter` is returned.
NoiseType noise_type(std::vector<std::vector<double>> averages,
                     NoiseType shorter);

}  // namespace beamgyro::internal
