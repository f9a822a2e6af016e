// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "random/random_stream.h"
#include "sim/numerics/state_archive.h"

namespace beamgyro::internal {

/// The flicker bank: 23 independent Ornstein-Uhlenbeck processes of decay rates
///   lam_k = 2 pi 1e-5 2^k rad/s, k = 0..22,
/// each of variance (B^2 / pi) ln 2. Its spectrum is B^2 / (2 pi f) (two-sided)
/// between 1e-5 and 42 Hz.
inline constexpr std::size_t kFlickerPoles = 23;
inline constexpr std::size_t kFlickerSlots = 24;  // filled up for the processor
double flicker_decay_rate(std::size_t k);         // lam_k [rad/s]
double flicker_pole_variance(double bias_instability);  // [(rad/s)^2]

/// The bank at the sample times m / output_rate, driven by one normal number
/// e_m for each sample (innovations form):
///   x_k,m = pole_k x_k,m-1 + gain_k e_m,   y_m = direct e_m + sum_k x_k,m.
/// This is exact: its autocovariance is that of the bank, sum_k variance
/// e^(-lam_k |m| / output_rate), at every lag, so both have the same law. It is
/// the causal factor of the sampled spectrum of the bank. The zeros of that
/// factor are real, and there is one between each two poles.
struct FlickerFilter {
  double direct = 0.0;       // [rad/s]
  std::vector<double> pole;  // e^(-lam_k / output_rate), falling
  std::vector<double> gain;  // [rad/s], one per pole, > 0

  /// Row k, column j <= k: the stationary state is x_k = sum_j root[k][j] n_j
  /// with independent unit normals n_j.
  std::vector<std::vector<double>> stationary_root;  // [rad/s]
};

/// Computes the filter. Poles that decay within one sample, e^(-lam_k /
/// output_rate) < 2^-53, are combined in `direct`. Throws std::invalid_argument
/// for an instability below 0, an output rate [Hz] not above 0, or one not
/// finite.
FlickerFilter flicker_filter(double bias_instability, double output_rate);

/// Flicker noise [rad/s] of one run, stationary from the first sample.
class FlickerNoise {
 public:
  /// Arguments are as in flicker_filter(). The numbers come from the stream
  /// kFlicker.
  FlickerNoise(double bias_instability, double output_rate, std::uint64_t seed,
               std::uint32_t device, std::uint32_t run);

  /// Adds the noise of the next rate.size() samples.
  void add_next(std::span<double> rate);

  void archive(StateArchive& archive) { archive(stream_, state_); }

 private:
  RandomStream stream_;
  double direct_;
  std::array<double, kFlickerSlots> pole_{}, gain_{}, state_{};
};

}  // namespace beamgyro::internal
