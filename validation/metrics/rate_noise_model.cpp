// SPDX-License-Identifier: MIT
#include "validation/metrics/rate_noise_model.h"

#include <algorithm>
#include <cmath>

#include "compensation/scoring/stated_values.h"
#include "sim/signal/flicker.h"

namespace beamgyro {
namespace {

constexpr double kThirdDifferences = 20.0;  // [-], variance, of white noise
constexpr double kMedianSize = 0.6744897501960817;  // [-], of a unit normal
constexpr double kShortMean = 1.0;                  // [s]
constexpr double kLongMean = 60.0;                  // [s]
constexpr std::size_t kLeastDifferences = 16;
constexpr double kForgotten = 8.0;  // [-], decay rate times length of a segment

/// Covariance of the means of n samples of a process of variance one and
/// correlation `rho` between neighbours, `lag` means apart.
double covariance_of_means(double rho, double n, int lag) {
  if (!(rho < 1.0)) return 1.0;
  const double sum = (1.0 - std::pow(rho, n)) / (n * (1.0 - rho));
  if (lag > 0) return std::pow(rho, (lag - 1) * n + 1.0) * sum * sum;
  return ((1.0 + rho) / (1.0 - rho) - 2.0 * rho * sum / (1.0 - rho)) / n;
}

/// Variance of the third differences of means of n samples of flicker with a
/// bias instability of one.
double flicker_differences(double n, double step) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kFlickerPoles; ++k) {
    const double rho = std::exp(-flicker_decay_rate(k) * step);
    const auto at = [&](int lag) { return covariance_of_means(rho, n, lag); };
    sum += 20.0 * at(0) - 30.0 * at(1) + 12.0 * at(2) - 2.0 * at(3);
  }
  return flicker_pole_variance(1.0) * sum;
}

struct ThirdDifferences {
  double variance = 0.0;  // of their median size, as of a normal
  std::size_t count = 0;
  double n = 1.0;  // samples of each mean
};

ThirdDifferences third_differences(const Recording& recording,
                                   std::span<const double> values,
                                   std::size_t n) {
  std::vector<double> sizes;
  for (const SampleRange& stretch : powered_stretches(recording)) {
    std::vector<double> means;
    for (std::size_t k = stretch.begin; k + n <= stretch.end; k += n) {
      double sum = 0.0;
      for (std::size_t i = k; i < k + n; ++i) sum += values[i];
      means.push_back(sum / static_cast<double>(n));
    }
    for (std::size_t i = 3; i < means.size(); ++i) {
      const double d =
          means[i] - 3.0 * means[i - 1] + 3.0 * means[i - 2] - means[i - 3];
      if (std::isfinite(d)) sizes.push_back(std::abs(d));
    }
  }
  ThirdDifferences found{0.0, sizes.size(), static_cast<double>(n)};
  if (sizes.empty()) return found;
  const auto middle =
      sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  found.variance = std::pow(*middle / kMedianSize, 2);
  return found;
}

std::size_t samples_in(double length, double step) {
  return step > 0.0
             ? std::max<std::size_t>(
                   1, static_cast<std::size_t>(std::round(length / step)))
             : 1;
}

}  // namespace

std::optional<NoiseLevels> stated_noise(const Recording& recording) {
  const auto level = [&](const char* key) {
    return stated_device_number(recording, key);
  };
  const auto white = level("noise.angle_random_walk_deg_per_sqrt_s");
  if (!white) return std::nullopt;
  if (stated_scenario_flag(recording, "noise.enabled") == false)
    return NoiseLevels{};
  return NoiseLevels{
      *white, level("noise.bias_instability_deg_per_s").value_or(0.0),
      level("noise.rate_random_walk_deg_per_s_per_sqrt_s").value_or(0.0),
      level("noise.turn_on_deg_per_s").value_or(0.0)};
}

NoiseLevels seen_noise(const Recording& recording,
                       std::span<const double> residual) {
  const double step = usual_step(recording);
  const std::size_t few = residual.size() / kLeastDifferences;
  const std::size_t n =
      std::clamp<std::size_t>(few, 1, samples_in(kShortMean, step));
  const ThirdDifferences seen = third_differences(recording, residual, n);
  // White noise of N = 1 has the variance 1/step a sample.
  const double white = kThirdDifferences / (seen.n * step);
  if (const auto stated = stated_noise(recording)) {
    const double expected = std::pow(stated->angle_random_walk, 2) * white +
                            std::pow(stated->bias_instability, 2) *
                                flicker_differences(seen.n, step);
    const double scale =
        expected > 0.0 ? std::min(1.0, std::sqrt(seen.variance / expected))
                       : 1.0;
    const double above = std::max(0.0, seen.variance - expected) / white;
    return {std::hypot(scale * stated->angle_random_walk, std::sqrt(above)),
            scale * stated->bias_instability, scale * stated->rate_random_walk,
            scale * stated->turn_on};
  }
  NoiseLevels levels{.angle_random_walk = std::sqrt(seen.variance / white)};
  const std::size_t many = samples_in(kLongMean, step);
  const ThirdDifferences slow = third_differences(recording, residual, many);
  const double by_white = seen.variance * seen.n / slow.n;
  const double chance =
      slow.count < kLeastDifferences
          ? HUGE_VAL
          : 4.0 * by_white / std::sqrt(static_cast<double>(slow.count));
  if (many > n && slow.variance - by_white > chance)
    levels.bias_instability = std::sqrt((slow.variance - by_white) /
                                        flicker_differences(slow.n, step));
  return levels;
}

SegmentNoise::SegmentNoise(const NoiseLevels& levels,
                           std::span<const Segment> segments)
    : turn_on_(levels.turn_on), none_(levels == NoiseLevels{}) {
  if (none_ || segments.empty()) {
    deviations_.assign(segments.size(), 0.0);
    return;
  }
  const double shortest =
      std::ranges::min(segments, {}, &Segment::length).length;  // [s]
  while (poles_ < kFlickerPoles &&
         flicker_decay_rate(poles_) * shortest < kForgotten)
    ++poles_;
  const double pole = flicker_pole_variance(levels.bias_instability);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const auto n = static_cast<double>(segment.samples.size());
    const double step = segment.length / n;
    double white = std::pow(levels.angle_random_walk, 2) / segment.length;
    double all =
        levels.turn_on * levels.turn_on +
        std::pow(levels.rate_random_walk, 2) * std::max(0.0, segment.time);
    const double since =
        i == 0 ? segment.time : segment.time - segments[i - 1].time;
    for (std::size_t k = 0; k < kFlickerPoles; ++k) {
      const double rate = flicker_decay_rate(k);
      const double variance =
          pole * covariance_of_means(std::exp(-rate * step), n, 0);
      if (k < poles_) {
        const double rho = i == 0 ? 0.0 : std::exp(-rate * since);
        flicker_.push_back(
            {rho, std::sqrt(1.0 - rho * rho), std::sqrt(variance)});
        all += variance;
      } else {
        white += variance;
      }
    }
    steps_.push_back({std::sqrt(white),
                      levels.rate_random_walk * std::sqrt(std::max(0.0, since)),
                      i == 0 || segment.power_on != segments[i - 1].power_on});
    deviations_.push_back(std::sqrt(all + white));
  }
}

void SegmentNoise::draw(RandomStream& random, std::span<double> means) const {
  std::ranges::fill(means, 0.0);
  if (none_) return;
  std::vector<double> normal(poles_ + 3);
  std::vector<double> state(poles_, 0.0);
  double walk = 0.0;
  double offset = 0.0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    random.fill_normal(normal);
    const Step& step = steps_[i];
    double flicker = 0.0;
    for (std::size_t k = 0; k < poles_; ++k) {
      const SharedFlicker& shared = flicker_[i * poles_ + k];
      state[k] = shared.correlation * state[k] + shared.fresh * normal[k];
      flicker += shared.part * state[k];
    }
    walk += step.walk * normal[poles_];
    if (step.powered_on) offset = turn_on_ * normal[poles_ + 2];
    means[i] = flicker + walk + offset + step.white * normal[poles_ + 1];
  }
}

}  // namespace beamgyro
