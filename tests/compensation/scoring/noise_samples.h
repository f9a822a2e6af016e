// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "compensation/scoring/even_series.h"
#include "random/random_stream.h"

namespace beamgyro::internal {

/// Rates of one type of noise, sampled every `interval` [s]: of the coefficient
/// one in seconds, and of the run `run`.
class NoiseSamples {
 public:
  NoiseSamples(std::size_t samples, double interval, std::uint32_t run)
      : samples_(samples), interval_(interval), run_(run) {}

  std::vector<double> white() const {
    auto rates = normals(0, samples_);
    for (double& rate : rates) rate /= std::sqrt(interval_);
    return rates;
  }

  /// The walk at the end of each sample.
  std::vector<double> random_walk() const {
    auto rates = normals(1, samples_);
    double sum = 0.0;
    for (double& rate : rates) rate = sum += std::sqrt(interval_) * rate;
    return rates;
  }

  /// Spectrum 1/(2 pi f): processes of one pole each, whose time constants
  /// double from a quarter of a sample to four times the record and whose
  /// variance is ln 2/pi.
  std::vector<double> flicker() const {
    std::vector<double> rates(samples_, 0.0);
    const double deviation = std::sqrt(std::numbers::ln2 / std::numbers::pi);
    std::uint32_t purpose = 100;
    for (double time_constant = interval_ / 4.0;
         time_constant < 4.0 * interval_ * static_cast<double>(samples_);
         time_constant *= 2.0) {
      const auto noise = normals(purpose++, samples_ + 1);
      const double keep = std::exp(-interval_ / time_constant);
      const double renew = deviation * std::sqrt(1.0 - keep * keep);
      double state = deviation * noise[samples_];
      for (std::size_t k = 0; k < samples_; ++k) {
        rates[k] += state;
        state = keep * state + renew * noise[k];
      }
    }
    return rates;
  }

  /// Errors of one in the angles at both ends of a sample.
  std::vector<double> quantisation() const {
    const auto errors = normals(2, samples_ + 1);
    std::vector<double> rates(samples_);
    for (std::size_t k = 0; k < samples_; ++k)
      rates[k] = (errors[k + 1] - errors[k]) / interval_;
    return rates;
  }

  std::vector<double> ramp() const {
    std::vector<double> rates(samples_);
    for (std::size_t k = 0; k < samples_; ++k)
      rates[k] = interval_ * static_cast<double>(k);
    return rates;
  }

 private:
  std::vector<double> normals(std::uint32_t purpose, std::size_t count) const {
    RandomStream stream(20261122, 0, run_, RandomPurpose{purpose});
    std::vector<double> values(count);
    stream.fill_normal(values);
    return values;
  }

  std::size_t samples_;
  double interval_;
  std::uint32_t run_;
};

inline EvenSeries series_of(const std::vector<double>& rates, double interval) {
  EvenSeries series;
  series.stretches.push_back(rates);
  series.interval = interval;
  series.samples = rates.size();
  return series;
}

}  // namespace beamgyro::internal
