// SPDX-License-Identifier: MIT
#include "sim/signal/flicker.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

// 1 - e^-x
double decayed(double x) { return -std::expm1(-x); }

// Zeros of the sampled spectrum. With poles at e^-mu_k, mu rising, and `pooled`
// white variances beside them, the spectrum over one pole's variance is
//   S(mu) = pooled + sum_k sinh mu_k / (cosh mu_k - cosh mu),  mu = i omega /
//   f,
// which rises from -inf to inf between two neighbouring mu_k: one zero each,
// and one above the last if anything is pooled. Bisection in cosh mu - 1, whose
// differences do not cancel.
std::vector<double> spectrum_zeros(const std::vector<double>& mu,
                                   std::size_t pooled) {
  std::vector<double> cosh1, sinh;
  for (double m : mu) {
    cosh1.push_back(2.0 * std::sinh(0.5 * m) * std::sinh(0.5 * m));
    sinh.push_back(std::sinh(m));
  }
  if (pooled > 0 && !mu.empty()) {
    const double share =
        static_cast<double>(mu.size() + pooled) / static_cast<double>(pooled);
    cosh1.push_back(std::cosh(mu.back() + std::log(2.0 * share)));
  }
  std::vector<double> zeros;
  for (std::size_t j = 0; j + 1 < cosh1.size(); ++j) {
    double low = cosh1[j], high = cosh1[j + 1];
    for (double q = 0.5 * (low + high); low < q && q < high;
         q = 0.5 * (low + high)) {
      double spectrum = static_cast<double>(pooled);
      for (std::size_t k = 0; k < mu.size(); ++k)
        spectrum += sinh[k] / (cosh1[k] - q);
      (spectrum < 0.0 ? low : high) = q;
    }
    zeros.push_back(2.0 * std::asinh(std::sqrt(0.5 * low)));
  }
  return zeros;
}

// Partial fractions of prod_j (1 - e^-zero_j / z) / prod_k (1 - e^-mu_k / z);
// the factors are taken in pairs, so that no product overflows.
std::vector<double> residues(const std::vector<double>& mu,
                             const std::vector<double>& zeros) {
  std::vector<double> c(mu.size(), 1.0);
  for (std::size_t k = 0; k < mu.size(); ++k) {
    for (std::size_t j = 0; j < mu.size(); ++j) {
      if (j < zeros.size()) c[k] *= decayed(zeros[j] - mu[k]);
      if (j != k) c[k] /= decayed(mu[j] - mu[k]);
    }
  }
  return c;
}

// Cholesky root of gain_k gain_j / (1 - pole_k pole_j) in closed form: the
// states' responses in the orthonormal basis of cascaded all-passes
// (Takenaka-Malmquist) of the same poles.
std::vector<std::vector<double>> flicker_stationary_root(
    const std::vector<double>& mu, const std::vector<double>& gain) {
  std::vector<std::vector<double>> root(mu.size());
  for (std::size_t k = 0; k < mu.size(); ++k) {
    double all_pass = gain[k];
    for (std::size_t j = 0; j <= k; ++j) {
      const double pair = decayed(mu[j] + mu[k]);
      root[k].push_back(all_pass * std::sqrt(decayed(2.0 * mu[j])) / pair);
      all_pass *= std::exp(-mu[j]) * std::expm1(mu[j] - mu[k]) / pair;
    }
  }
  return root;
}

}  // namespace

double flicker_decay_rate(std::size_t k) {
  return 2.0 * std::numbers::pi * 1e-5 * std::ldexp(1.0, static_cast<int>(k));
}

double flicker_pole_variance(double bias_instability) {
  return bias_instability * bias_instability * std::numbers::ln2 /
         std::numbers::pi;
}

FlickerFilter flicker_filter(double bias_instability, double output_rate) {
  if (!(bias_instability >= 0.0) || !std::isfinite(bias_instability))
    throw std::invalid_argument(fmt::format(
        "bias instability is {} rad/s, must be 0 or more", bias_instability));
  if (!(output_rate > 0.0) || !std::isfinite(output_rate))
    throw std::invalid_argument(
        fmt::format("output rate is {} Hz, must be above 0", output_rate));
  constexpr double kForgotten = 53.0 * std::numbers::ln2;
  std::vector<double> mu;
  for (std::size_t k = 0; k < kFlickerPoles; ++k) {
    const double decay = flicker_decay_rate(k) / output_rate;
    if (decay < kForgotten) mu.push_back(decay);
  }
  const std::size_t pooled = kFlickerPoles - mu.size();
  const std::vector<double> zeros = spectrum_zeros(mu, pooled);

  // The scale: the spectrum at half the output rate, where no sum cancels.
  double spectrum = static_cast<double>(pooled);
  double response = 1.0;
  double direct = pooled > 0 ? 1.0 : 0.0;
  for (std::size_t k = 0; k < mu.size(); ++k) {
    spectrum += std::tanh(0.5 * mu[k]);
    response /= 1.0 + std::exp(-mu[k]);
    if (k >= zeros.size()) continue;
    response *= 1.0 + std::exp(-zeros[k]);
    direct *= std::exp(mu[k] - zeros[k]);
  }
  const double scale =
      std::sqrt(flicker_pole_variance(bias_instability) * spectrum) / response;

  FlickerFilter filter;
  filter.direct = scale * direct;
  filter.gain = residues(mu, zeros);
  for (double& gain : filter.gain) gain *= scale;
  for (double m : mu) filter.pole.push_back(std::exp(-m));
  filter.stationary_root = flicker_stationary_root(mu, filter.gain);
  return filter;
}

FlickerNoise::FlickerNoise(double bias_instability, double output_rate,
                           std::uint64_t seed, std::uint32_t device,
                           std::uint32_t run)
    : stream_(seed, device, run, kFlickerStream) {
  const FlickerFilter filter = flicker_filter(bias_instability, output_rate);
  direct_ = filter.direct;
  std::copy(filter.pole.begin(), filter.pole.end(), pole_.begin());
  std::copy(filter.gain.begin(), filter.gain.end(), gain_.begin());
  std::array<double, kFlickerPoles> n{};
  stream_.fill_normal(n);
  for (std::size_t k = 0; k < filter.pole.size(); ++k)
    for (std::size_t j = 0; j <= k; ++j)
      state_[k] += filter.stationary_root[k][j] * n[j];
}

void FlickerNoise::add_next(std::span<double> rate) {
  std::array<double, 1024> normal;
  auto state = state_;
  while (!rate.empty()) {
    const std::size_t count = std::min(rate.size(), normal.size());
    stream_.fill_normal(std::span(normal).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const double e = normal[i];
      static_assert(kFlickerSlots == 24);
      // Fixed lengths and no running sum, so that the loops vectorise.
      for (std::size_t k = 0; k < kFlickerSlots; ++k)
        state[k] = pole_[k] * state[k] + gain_[k] * e;
      std::array<double, kFlickerSlots / 3> sum;
      for (std::size_t k = 0; k < kFlickerSlots / 3; ++k)
        sum[k] = state[k] + state[k + kFlickerSlots / 3] +
                 state[k + 2 * kFlickerSlots / 3];
      for (std::size_t k = 0; k < 4; ++k) sum[k] += sum[k + 4];
      rate[i] += direct_ * e + ((sum[0] + sum[2]) + (sum[1] + sum[3]));
    }
    rate = rate.subspan(count);
  }
  state_ = state;
}

}  // namespace beamgyro::internal
