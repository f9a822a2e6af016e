// SPDX-License-Identifier: MIT
#include "sim/scenario/rate_profile.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "linear_algebra/cholesky.h"

namespace beamgyro::internal {
namespace {

// The pair of poles w is -3 dB where (1 + (2 pi f/w)^2)^2 = 2.
const double kCornerPerBandwidth =
    2 * std::numbers::pi / std::sqrt(std::sqrt(2.0) - 1);

bool differs_from_zero(const SineSignal& sine) {
  return sine.amplitude != 0 || sine.offset != 0;
}

bool differs_from_zero(const RandomRate& random) { return random.rms != 0; }

bool differs_from_zero(const PiecewiseLinear& points) {
  return std::any_of(points.values().begin(), points.values().end(),
                     [](double value) { return value != 0; });
}

}  // namespace

bool moves(const RateProfile& profile) {
  return std::visit([](const auto& form) { return differs_from_zero(form); },
                    profile);
}

bool moves(const Signal& signal) {
  return std::visit([](const auto& form) { return differs_from_zero(form); },
                    signal);
}

PerAxis<RateProfile> no_motion() {
  const PiecewiseLinear still = PiecewiseLinear::constant(0);
  return {still, still, still, still, still, still};
}

std::vector<double> values_at(const Signal& signal,
                              std::span<const double> times) {
  const auto* sine = std::get_if<SineSignal>(&signal);
  if (sine == nullptr) return std::get<PiecewiseLinear>(signal).sample(times);
  std::vector<double> values;
  values.reserve(times.size());
  for (const double t : times) {
    values.push_back(
        sine->offset +
        sine->amplitude *
            std::sin(2 * std::numbers::pi * sine->frequency * t + sine->phase));
  }
  return values;
}

PiecewiseLinear realised(const RandomRate& random, double duration,
                         std::uint64_t seed, std::uint32_t device,
                         std::uint32_t run, RandomPurpose purpose) {
  const double h = 1 / (16 * random.bandwidth);
  const double w = kCornerPerBandwidth * random.bandwidth;
  const double correlation = std::exp(-w * h) * (1 + w * h);
  const double variance =
      random.rms * random.rms * 3 / (2 + correlation);  // at grid points

  // x1' = -w x1 + white noise, x2' = w (x1 - x2), stationary covariance P.
  Eigen::Matrix2d P, step;
  P << 2 * variance, variance, variance, variance;
  step << 1, 0, w * h, 1;
  step *= std::exp(-w * h);
  const Eigen::Matrix2d root =
      Cholesky(P - step * P * step.transpose()).lower();

  RandomStream stream(seed, device, run, purpose);
  const auto draw = [&] {
    Eigen::Vector2d n;
    n(0) = stream.normal();
    n(1) = stream.normal();
    return n;
  };
  Eigen::Vector2d x = Eigen::Matrix2d(Cholesky(P).lower()) * draw();
  const auto count = static_cast<std::size_t>(std::ceil(duration / h)) + 1;
  std::vector<double> time(count), value(count);
  for (std::size_t k = 0; k < count; ++k) {
    time[k] = static_cast<double>(k) * h;
    value[k] = x(1);
    x = step * x + root * draw();
  }
  return {std::move(time), std::move(value)};
}

}  // namespace beamgyro::internal
