// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "compensation/uncertainty/bias_sigma.h"
#include "validation/evidence/evidence.h"

namespace beamgyro::internal {

constexpr double kFilterAverage = 1.0;  // [s], of a measurement
// [K], between measurements: so long that the correlation that is assumed
// matters little, exp(-2.5) = 0.08 of it being left.
constexpr double kFilterStep = 2.5 * kBiasCorrelation;

/// A measurement of a Kalman filter and what the filter expected.
struct Innovation {
  double squared;   // nu^2 [(deg/s)^2]
  double expected;  // S [(deg/s)^2]

  double normalised() const { return squared / expected; }
};

/// A Kalman filter whose one state is the bias of a compensated rate, b. It
/// believes the sigma that the compensator states:
///
///   at power-on        b = 0, P = sigma^2                             (F.1)
///   from k - 1 to k    b <- c b, P <- c^2 P + q                       (F.2)
///   measurement y of   nu = y - b, S = P + R                          (F.3)
///   the rate at rest   b <- b + P nu / S, P <- P R / S                (F.4)
///
/// c and q are those of bias_step(). The normalised innovation squared nu^2 / S
/// has the mean 1 if sigma is right.
class BiasFilter {
 public:
  /// Starts at a power-on (F.1), at a temperature [degC].
  BiasFilter(double sigma, double temperature);

  /// Goes on to another sigma [deg/s] and temperature [degC] (F.2).
  void predict(double sigma, double temperature);

  /// Takes a rate error [deg/s] with the variance R [(deg/s)^2] (F.3, F.4).
  Innovation measure(double error, double variance);

 private:
  double sigma_, temperature_;
  double bias_ = 0.0;  // [deg/s]
  double variance_;    // P [(deg/s)^2]
};

/// Returns the innovations of the filter in a run whose rate has a sigma, at
/// rest or at a held rate. It measures the mean residual of kFilterAverage, or
/// of a sample that is longer, as a vehicle does that stops for it: at each
/// power-on, and where the temperature has moved by kFilterStep since the last
/// measurement. R is the white noise of such a mean: N^2 of seen_noise()
/// over its length. Samples without a rate or with a loop that is not locked
/// are waited for.
std::vector<Innovation> filter_innovations(const EvidenceRun& run);

}  // namespace beamgyro::internal
