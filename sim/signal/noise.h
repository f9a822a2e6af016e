// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "random/random_stream.h"
#include "sim/numerics/state_archive.h"
#include "sim/signal/flicker.h"

namespace beamgyro::internal {

/// The walk W(age) [sqrt(s)] of one device since its factory trim: a
/// first-order Gauss-Markov process with W(0) = 0,
///   dW = -W dt/t_c + unit white noise,  var W = (t_c/2) (1 - e^{-2 age/t_c}).
/// Over times well below t_c it is a Wiener path; over longer ones it is
/// bounded. It is one path for every run of a seed and device, in whatever
/// order the ages are asked for, so a run goes on where an earlier one ended.
/// Drawn by halving intervals of the path (Levy) down to 1 s, with straight
/// lines between.
class WalkSinceTrim {
 public:
  /// `correlation` is t_c [s] > 0.
  WalkSinceTrim(std::uint64_t seed, std::uint32_t device, double correlation);

  /// Returns W(age). Fast where the age is near that of the last call. Throws
  /// std::invalid_argument for an age [s] outside 0 .. 2^32.
  double at(double age);

 private:
  struct Interval {
    double start, length;  // [s]
    double first, last;    // W at its ends
    double middle;         // W at its middle, for those that are halved
    std::uint32_t number;  // of its halves: 2 number and 2 number + 1
    bool holds(double age) const {
      return age >= start && age < start + length;
    }
  };
  void push(double start, double length, double first, double last,
            std::uint32_t number);
  double normal(std::uint32_t number) const;

  std::uint64_t seed_;
  std::uint32_t device_;
  double correlation_;          // t_c [s]
  std::vector<Interval> path_;  // each but the first is half of the one before
};

/// Noise of the rate signal, IEEE-952 two-sided conventions: Allan variance
///   sigma^2(tau) = N^2 / tau + (2 ln 2 / pi) B^2 + K^2 tau / 3.
struct NoiseParameters {
  double angle_random_walk = 0.0;    // N [rad/sqrt(s)]
  double bias_instability = 0.0;     // B [rad/s]
  double rate_random_walk = 0.0;     // K [rad/s/sqrt(s)]
  double turn_on = 0.0;              // one sigma, per power cycle [rad/s]
  double turn_on_transient = 0.0;    // one sigma of A, per power cycle [rad/s]
  double turn_on_settling = 200.0;   // tau_t of the transient [s]
  double turn_on_recovery = 3600.0;  // tau_off, while power is off [s]
  double walk_correlation = 3.6e5;   // t_c of WalkSinceTrim [s]
};

/// Returns `noise` with an independent white noise N [rad/sqrt(s)] more.
NoiseParameters with_white_noise(NoiseParameters noise, double N);

/// White noise, flicker and rate random walk of one run [rad/s], one value a
/// sample at the times m / output_rate:
///   white    variance N^2 x output_rate,
///   flicker  see FlickerFilter, stationary from the start,
///   walk     of a run at an age, K times WalkSinceTrim; else 0 at the first
///            sample, with steps of variance K^2 / output_rate, without bound.
///            It goes on through power-off.
/// The noise does not depend on how a run is cut into calls.
class RateNoise {
 public:
  /// `age` [s] is the time since the trim at the first sample, where the run
  /// has one. Throws std::invalid_argument for a parameter below 0, an output
  /// rate [Hz] not above 0, or one not finite.
  RateNoise(const NoiseParameters& parameters, double output_rate,
            std::uint64_t seed, std::uint32_t device, std::uint32_t run,
            std::optional<double> age = {});

  /// Adds the noise of the next rate.size() samples. Throws as WalkSinceTrim.
  void add_next(std::span<double> rate);

  void archive(StateArchive& archive);

 private:
  void add_walk(std::span<double> rate);
  void add_walk_since_trim(std::span<double> rate);

  double output_rate_;  // [Hz]
  double white_sigma_;  // [rad/s]
  double walk_K_;       // K [rad/s/sqrt(s)]
  double walk_ = 0.0;   // at the next sample [rad/s]
  RandomStream white_stream_;
  RandomStream walk_stream_;
  std::optional<FlickerNoise> flicker_;  // none when B = 0
  double age_ = 0;                       // at the first sample [s]
  std::size_t aged_samples_ = 0;         // of walk_since_trim_, taken
  std::optional<WalkSinceTrim> walk_since_trim_;
};

/// Returns what is left of a turn-on transient of size 1 after the power was
/// off for `off_time` [s]: 1 - e^{-t_off/tau_off}.
double recovered_transient(const NoiseParameters& parameters, double off_time);

/// Turn-on offsets [rad/s] of the first `cycles` power cycles of a run,
/// independent normals of sigma parameters.turn_on; cycle i gets the same value
/// whatever `cycles`. Throws as RateNoise.
std::vector<double> turn_on_offsets(const NoiseParameters& parameters,
                                    std::size_t cycles, std::uint64_t seed,
                                    std::uint32_t device, std::uint32_t run);

/// Turn-on transients of the first power cycles of a run at power-on [rad/s],
///   A (1 - e^{-t_off/tau_off}),
/// with independent normals A of sigma parameters.turn_on_transient and the
/// time t_off [s] that the power was off before each cycle; it may be infinite.
/// A time t after power-on e^{-t/tau_t} of it is left. Throws as RateNoise.
std::vector<double> turn_on_transients(const NoiseParameters& parameters,
                                       std::span<const double> off_times,
                                       std::uint64_t seed, std::uint32_t device,
                                       std::uint32_t run);

}  // namespace beamgyro::internal
