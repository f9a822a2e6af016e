// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "random/random_stream.h"
#include "validation/metrics/segments.h"

namespace beamgyro::internal {

/// Noise of a rate, of the same law as that of the simulator: white noise,
/// flicker, a random walk from time 0 on, an offset at each power-on and a
/// transient A (1 - e^(-t_off/tau_off)) e^(-t/tau_t) from it on.
struct NoiseLevels {
  double angle_random_walk = 0.0;  // N [deg/sqrt(s)]
  double bias_instability = 0.0;   // B [deg/s]
  double rate_random_walk = 0.0;   // K [deg/s/sqrt(s)]
  double turn_on = 0.0;            // 1-sigma [deg/s]
  double turn_on_transient = 0.0;  // 1-sigma of A [deg/s]
  double turn_on_settling = 0.0;   // tau_t [s], where there is a transient
  double turn_on_recovery = 0.0;   // tau_off [s], likewise

  bool operator==(const NoiseLevels&) const = default;
};

/// Returns the noise that the device file of a recording states, none at all
/// where the scenario has switched it off, or nothing without a device file.
std::optional<NoiseLevels> stated_noise(const Recording& recording);

/// Returns the noise of a residual [deg/s]. The third differences of its means
/// over 1 s or a sample, whichever is longer, tell its size, since they do not
/// see a smooth drift: their median size is that of white noise and flicker.
/// - If the device states its noise, all of it is scaled to that size; what is
///   above it is white.
/// - Otherwise those of means over 15, 30 and 60 s tell the flicker, the least
///   of the three, since a drift shows more in the longer ones. In a run that
///   turns or is accelerated only the white noise is told.
/// A residual without noise has none, whatever the device states.
NoiseLevels seen_noise(const Recording& recording,
                       std::span<const double> residual);

/// The noise of the means over segments of one run, in order of time.
class SegmentNoise {
 public:
  SegmentNoise(const NoiseLevels& levels, std::span<const Segment> segments);

  bool none() const { return none_; }
  const std::vector<double>& standard_deviations() const {  // [deg/s]
    return deviations_;
  }

  /// Writes the noise [deg/s] of every segment, drawn from `random`.
  void draw(RandomStream& random, std::span<double> means) const;

  bool operator==(const SegmentNoise&) const = default;

 private:
  struct Step {
    bool operator==(const Step&) const = default;
    double white;      // [deg/s], 1-sigma of all that neighbours do not share
    double walk;       // [deg/s], 1-sigma of the walk since the segment before
    double transient;  // [deg/s], of a transient of one sigma
    bool powered_on;   // since the segment before
  };
  // One slow pole over one segment, of unit variance, after its value e at the
  // last sample of the segment before: its value e' at the last one, and its
  // mean but for what is independent of both.
  struct PoleStep {
    bool operator==(const PoleStep&) const = default;
    double carried, fresh;  // e' = carried e + fresh n
    double mean, shared;    // mean = mean e + shared n
  };
  double turn_on_ = 0.0;  // [deg/s]
  bool transient_ = false;
  bool none_ = true;
  std::size_t poles_ = 0;
  std::vector<Step> steps_;
  double pole_sigma_ = 0.0;         // [deg/s]
  std::vector<PoleStep> flicker_;   // by segment, then pole
  std::vector<double> deviations_;  // [deg/s]
};

}  // namespace beamgyro::internal
