// SPDX-License-Identifier: MIT
#include "validation/metrics/rate_noise_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "dataset/recording/stated_values.h"
#include "sim/signal/flicker.h"
#include "sim/signal/noise.h"

namespace beamgyro::internal {
namespace {

constexpr double kThirdDifferences = 20.0;  // [-], variance, of white noise
constexpr double kMedianSize = 0.6744897501960817;     // [-], of a unit normal
constexpr double kShortMean = 1.0;                     // [s]
constexpr std::array kLongMeans = {15.0, 30.0, 60.0};  // [s]
constexpr std::size_t kLeastDifferences = 16;
constexpr double kChanceOfVariance =
    6.0;  // over the root of a number of differences
// Every second pole of the bank, with twice its variance, stands for two.
constexpr std::size_t kDrawnPoles = (kFlickerPoles + 1) / 2;
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
    for (std::size_t k = stretch.begin; k + n <= stretch.end; k += n)
      means.push_back(mean_of(values.subspan(k, n)));
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

NoiseLevels scaled_noise(NoiseLevels levels, double factor) {
  if (!(factor > 0.0)) return {};
  for (double* size :
       {&levels.angle_random_walk, &levels.bias_instability,
        &levels.rate_random_walk, &levels.turn_on, &levels.turn_on_transient})
    *size *= factor;
  return levels;
}

/// What is left of a transient from power-on, as a mean over a segment.
double left_of_transient(const Segment& segment, double settling) {
  const double half = 0.5 * segment.length / settling;
  return std::exp(-segment.powered / settling) * std::sinh(half) / half;
}

/// Time [s] without power before a segment, the first since its power-on. The
/// one before it may not have lasted until the power went off.
double time_without_power(std::span<const Segment> segments, std::size_t i) {
  if (i == 0) return HUGE_VAL;
  const Segment& before = segments[i - 1];
  return std::max(0.0, segments[i].time - segments[i].powered - before.time -
                           0.5 * before.length);
}

std::size_t samples_in(double length, double step) {
  return step > 0.0
             ? std::max<std::size_t>(
                   1, static_cast<std::size_t>(std::round(length / step)))
             : 1;
}

/// Returns whether the gyro neither turns nor is accelerated, so that steps of
/// the residual are not taken for noise.
bool is_still(const Recording& recording) {
  const auto& truth = column_values(recording, "true_rate");
  return std::ranges::adjacent_find(truth, std::not_equal_to<>()) ==
             truth.end() &&
         std::ranges::none_of(recording.columns, [](const Column& column) {
           return column.name.starts_with("true_acceleration") ||
                  column.name.starts_with("true_cross_rate");
         });
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
  NoiseLevels stated{
      *white, level("noise.bias_instability_deg_per_s").value_or(0.0),
      level("noise.rate_random_walk_deg_per_s_per_sqrt_s").value_or(0.0),
      level("noise.turn_on_deg_per_s").value_or(0.0),
      level("noise.turn_on_transient_deg_per_s").value_or(0.0)};
  if (stated.turn_on_transient > 0.0) {
    const NoiseParameters usual;
    stated.turn_on_settling =
        level("noise.turn_on_settling_s").value_or(usual.turn_on_settling);
    stated.turn_on_recovery =
        level("noise.turn_on_recovery_s").value_or(usual.turn_on_recovery);
    // Of a run that is read from later on this much is left.
    stated.turn_on_transient *=
        std::exp(-recording.time.front() / stated.turn_on_settling);
  }
  return stated;
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
    // What is within chance is taken for the stated size.
    const double chance =
        std::min(0.5, kChanceOfVariance /
                          std::sqrt(static_cast<double>(seen.count + 1)));
    const double ratio = expected > 0.0 ? seen.variance / expected : 1.0;
    const double scale = ratio < 1.0 - chance ? std::sqrt(ratio) : 1.0;
    const double above = expected > 0.0 && ratio <= 1.0 + chance
                             ? 0.0
                             : std::max(0.0, seen.variance - expected) / white;
    NoiseLevels levels = scaled_noise(*stated, scale);
    levels.angle_random_walk =
        std::hypot(levels.angle_random_walk, std::sqrt(above));
    return levels;
  }
  NoiseLevels levels{.angle_random_walk = std::sqrt(seen.variance / white)};
  if (!is_still(recording)) return levels;
  double flicker = HUGE_VAL;  // square of B
  for (const double length : kLongMeans) {
    const std::size_t many = samples_in(length, step);
    const ThirdDifferences slow = third_differences(recording, residual, many);
    if (many <= n || slow.count < kLeastDifferences) return levels;
    const double by_white = seen.variance * seen.n / slow.n;
    const double chance =
        4.0 * by_white / std::sqrt(static_cast<double>(slow.count));
    const double above = slow.variance - by_white;
    flicker = std::min(flicker, above > chance
                                    ? above / flicker_differences(slow.n, step)
                                    : 0.0);
  }
  levels.bias_instability = std::sqrt(flicker);
  return levels;
}

SegmentNoise::SegmentNoise(const NoiseLevels& levels,
                           std::span<const Segment> segments)
    : turn_on_(levels.turn_on),
      transient_(levels.turn_on_transient > 0.0),
      none_(levels == NoiseLevels{}) {
  if (none_ || segments.empty()) {
    deviations_.assign(segments.size(), 0.0);
    return;
  }
  const double shortest =
      std::ranges::min(segments, {}, &Segment::length).length;  // [s]
  while (levels.bias_instability > 0.0 && poles_ < kDrawnPoles &&
         flicker_decay_rate(2 * poles_) * shortest < kForgotten)
    ++poles_;
  const double pole = 2.0 * flicker_pole_variance(levels.bias_instability);
  pole_sigma_ = std::sqrt(pole);
  double transient = 0.0;  // 1-sigma at the power-on [deg/s]
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
    const bool powered_on =
        i == 0 || segment.power_on != segments[i - 1].power_on;
    double left = 0.0;  // of the transient
    if (transient_) {
      if (powered_on)
        transient = levels.turn_on_transient *
                    -std::expm1(-time_without_power(segments, i) /
                                levels.turn_on_recovery);
      left = transient * left_of_transient(segment, levels.turn_on_settling);
      all += left * left;
    }
    for (std::size_t k = 0; k < kDrawnPoles; ++k) {
      const double rate = flicker_decay_rate(2 * k);
      const double rho = std::exp(-rate * step);
      const double variance = covariance_of_means(rho, n, 0);
      if (k >= poles_) {
        white += pole * variance;
        continue;
      }
      const double gap = i == 0 ? HUGE_VAL
                                : since - 0.5 * (segment.length - step) -
                                      0.5 * (segments[i - 1].length - step);
      const double kept = std::exp(-rate * gap);
      const double mean = (1.0 - std::pow(rho, n)) / (n * (1.0 - rho));
      const double carried = kept * std::pow(rho, n - 1.0);
      const double fresh = std::sqrt(std::max(0.0, 1.0 - carried * carried));
      const double shared =
          fresh > 0.0 ? mean * (1.0 - kept * carried) / fresh : 0.0;
      const double own =  // variance that no later segment shares
          std::max(0.0, variance - std::pow(mean * kept, 2) - shared * shared);
      all += pole * (variance - own);
      white += pole * own;
      flicker_.push_back({carried, fresh, mean * kept, shared});
    }
    steps_.push_back({std::sqrt(white),
                      levels.rate_random_walk * std::sqrt(std::max(0.0, since)),
                      left, powered_on});
    deviations_.push_back(std::sqrt(all + white));
  }
}

void SegmentNoise::draw(RandomStream& random, std::span<double> means) const {
  std::ranges::fill(means, 0.0);
  if (none_) return;
  std::vector<double> normal(poles_ + 2);
  std::vector<double> state(poles_, 0.0);
  double walk = 0.0;
  double offset = 0.0;
  double transient = 0.0;  // [-], of one sigma
  for (std::size_t i = 0; i < means.size(); ++i) {
    random.fill_normal(normal);
    const Step& step = steps_[i];
    double flicker = 0.0;
    for (std::size_t k = 0; k < poles_; ++k) {
      const PoleStep& pole = flicker_[i * poles_ + k];
      flicker += pole.mean * state[k] + pole.shared * normal[k];
      state[k] = pole.carried * state[k] + pole.fresh * normal[k];
    }
    walk += step.walk * normal[poles_];
    if (step.powered_on) {
      offset = turn_on_ * random.normal();
      if (transient_) transient = random.normal();
    }
    means[i] = pole_sigma_ * flicker + walk + offset +
               step.white * normal[poles_ + 1] + transient * step.transient;
  }
}

}  // namespace beamgyro::internal
