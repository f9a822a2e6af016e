// SPDX-License-Identifier: MIT
#include "sim/signal/noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

constexpr double kLongestWalk = 0x1p32, kWalkGrid = 1;  // [s]

void require_non_negative(double value, const char* name, const char* unit) {
  if (!(value >= 0.0) || !std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("{} is {} {}, must be 0 or more", name, value, unit));
}

void check_noise(const NoiseParameters& p) {
  require_non_negative(p.angle_random_walk, "angle random walk", "rad/sqrt(s)");
  require_non_negative(p.bias_instability, "bias instability", "rad/s");
  require_non_negative(p.rate_random_walk, "rate random walk", "rad/s/sqrt(s)");
  if (!(p.walk_correlation > 0.0) || !std::isfinite(p.walk_correlation))
    throw std::invalid_argument(
        fmt::format("correlation time of the walk is {} s, must be above 0",
                    p.walk_correlation));
  require_non_negative(p.turn_on, "turn-on offset", "rad/s");
  require_non_negative(p.turn_on_transient, "turn-on transient", "rad/s");
}

}  // namespace

NoiseParameters with_white_noise(NoiseParameters noise, double N) {
  noise.angle_random_walk = std::hypot(noise.angle_random_walk, N);
  return noise;
}

WalkSinceTrim::WalkSinceTrim(std::uint64_t seed, std::uint32_t device,
                             double correlation)
    : seed_(seed), device_(device), correlation_(correlation) {
  const double variance =
      -0.5 * correlation * std::expm1(-2 * kLongestWalk / correlation);
  push(0, kLongestWalk, 0, std::sqrt(variance) * normal(0), 1);
}

double WalkSinceTrim::normal(std::uint32_t number) const {
  return RandomStream(seed_, device_, number, kWalkSinceTrimStream).normal();
}

void WalkSinceTrim::push(double start, double length, double first, double last,
                         std::uint32_t number) {
  double middle = 0;
  if (length > kWalkGrid) {
    // A bridge of the process: its law given the values at both ends.
    const double decays = 0.5 * length / correlation_;  // of half the length
    const double variance = 0.5 * correlation_ * std::tanh(decays);
    middle = 0.5 * (first + last) / std::cosh(decays) +
             std::sqrt(variance) * normal(number);
  }
  path_.push_back({start, length, first, last, middle, number});
}

double WalkSinceTrim::at(double age) {
  if (!(age >= 0 && age <= kLongestWalk))
    throw std::invalid_argument(
        fmt::format("age is {} s, must be 0 to {}", age, kLongestWalk));
  while (path_.size() > 1 && !path_.back().holds(age)) path_.pop_back();
  while (path_.back().length > kWalkGrid) {
    const Interval i = path_.back();
    const double half = i.length / 2;
    if (age < i.start + half) {
      push(i.start, half, i.first, i.middle, 2 * i.number);
    } else {
      push(i.start + half, half, i.middle, i.last, 2 * i.number + 1);
    }
  }
  const Interval& i = path_.back();
  return i.first + (i.last - i.first) * ((age - i.start) / i.length);
}

RateNoise::RateNoise(const NoiseParameters& parameters, double output_rate,
                     std::uint64_t seed, std::uint32_t device,
                     std::uint32_t run, std::optional<double> age)
    : output_rate_(output_rate),
      white_sigma_(parameters.angle_random_walk * std::sqrt(output_rate)),
      walk_K_(parameters.rate_random_walk),
      white_stream_(seed, device, run, kWhiteNoiseStream),
      walk_stream_(seed, device, run, kRateRandomWalkStream) {
  check_noise(parameters);
  if (!(output_rate > 0.0) || !std::isfinite(output_rate))
    throw std::invalid_argument(
        fmt::format("output rate is {} Hz, must be above 0", output_rate));
  if (parameters.bias_instability > 0.0)
    flicker_.emplace(parameters.bias_instability, output_rate, seed, device,
                     run);
  if (age && walk_K_ > 0.0) {
    age_ = *age;
    walk_since_trim_.emplace(seed, device, parameters.walk_correlation);
  }
}

void RateNoise::add_walk(std::span<double> rate) {
  const double sigma = walk_K_ / std::sqrt(output_rate_);
  std::array<double, 1024> normal;
  const auto numbers = std::span(normal).first(rate.size());
  walk_stream_.fill_normal(numbers);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    rate[i] += walk_;
    walk_ += sigma * numbers[i];
  }
}

void RateNoise::add_walk_since_trim(std::span<double> rate) {
  for (double& r : rate) {
    const double t = static_cast<double>(aged_samples_++) / output_rate_;
    r += walk_K_ * walk_since_trim_->at(age_ + t);
  }
}

void RateNoise::add_next(std::span<double> rate) {
  if (flicker_) flicker_->add_next(rate);
  std::array<double, 1024> normal;
  while (!rate.empty()) {
    const std::size_t count = std::min(rate.size(), normal.size());
    const auto numbers = std::span(normal).first(count);
    if (white_sigma_ > 0.0) {
      white_stream_.fill_normal(numbers);
      for (std::size_t i = 0; i < count; ++i)
        rate[i] += white_sigma_ * numbers[i];
    }
    if (walk_since_trim_) {
      add_walk_since_trim(rate.first(count));
    } else if (walk_K_ > 0.0) {
      add_walk(rate.first(count));
    }
    rate = rate.subspan(count);
  }
}

// The walk since the trim follows from the age.
void RateNoise::archive(StateArchive& archive) {
  archive(walk_, white_stream_, walk_stream_, aged_samples_);
  if (flicker_) archive(*flicker_);
}

double recovered_transient(const NoiseParameters& parameters, double off_time) {
  return -std::expm1(-off_time / parameters.turn_on_recovery);
}

std::vector<double> turn_on_offsets(const NoiseParameters& parameters,
                                    std::size_t cycles, std::uint64_t seed,
                                    std::uint32_t device, std::uint32_t run) {
  check_noise(parameters);
  RandomStream stream(seed, device, run, kTurnOnStream);
  std::vector<double> offsets(cycles);
  stream.fill_normal(offsets);
  for (double& offset : offsets) offset *= parameters.turn_on;
  return offsets;
}

std::vector<double> turn_on_transients(const NoiseParameters& parameters,
                                       std::span<const double> off_times,
                                       std::uint64_t seed, std::uint32_t device,
                                       std::uint32_t run) {
  check_noise(parameters);
  RandomStream stream(seed, device, run, kTurnOnTransientStream);
  std::vector<double> transients(off_times.size());
  stream.fill_normal(transients);
  for (std::size_t i = 0; i < transients.size(); ++i)
    transients[i] *= parameters.turn_on_transient *
                     recovered_transient(parameters, off_times[i]);
  return transients;
}

}  // namespace beamgyro::internal
