// SPDX-License-Identifier: MIT
#include "sim/signal/flicker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/config/rejection.h"
#include "tests/sim/signal/allan_deviation.h"

namespace beamgyro::internal::flicker_test {
namespace {

constexpr double kB = 0.01;  // [rad/s]
const double kFloor = std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);

// Exact Allan deviation of the bank, each pole's part in closed form: averages
// over tau of the continuous signal,
double continuous_deviation(double tau) {
  double variance = 0.0;
  for (std::size_t k = 0; k < kFlickerPoles; ++k) {
    const double x = flicker_decay_rate(k) * tau;
    const double d = -std::expm1(-x);
    // 2 (x - d) - d^2, by its series where it cancels
    const double shape =
        x < 1e-3 ? x * x * x * (2.0 / 3.0 - x / 2.0) : 2.0 * (x - d) - d * d;
    variance += flicker_pole_variance(kB) * shape / (x * x);
  }
  return std::sqrt(variance);
}

// and of `m` samples of the signal at `rate`.
double sampled_deviation(double rate, double m) {
  double variance = 0.0;
  for (std::size_t k = 0; k < kFlickerPoles; ++k) {
    const double mu = flicker_decay_rate(k) / rate;
    const double pole = std::exp(-mu), lost = -std::expm1(-mu);
    const double d = -std::expm1(-m * mu);
    const double sum = m * (1.0 + pole) / lost - 2.0 * pole * d / (lost * lost);
    const double next = pole * d * d / (lost * lost);
    variance += flicker_pole_variance(kB) * (sum - next) / (m * m);
  }
  return std::sqrt(variance);
}

// Exact Allan deviation of what the filter makes of unit white noise: the
// energy of its answer to the Allan window, run backwards in time.
double filter_deviation(const FlickerFilter& filter, long m) {
  const std::size_t n = filter.pole.size();
  std::vector<double> x(n, 0.0);
  double energy = 0.0;
  for (long t = 2 * m - 1; t >= 0; --t) {
    const double window = (t < m ? -1.0 : 1.0) / static_cast<double>(m);
    double answer = filter.direct * window;
    for (std::size_t k = 0; k < n; ++k) {
      x[k] = filter.pole[k] * x[k] + filter.gain[k] * window;
      answer += x[k];
    }
    energy += answer * answer;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const double pair = filter.pole[i] * filter.pole[j];
      energy += x[i] * x[j] * pair / (1.0 - pair);
    }
  return std::sqrt(0.5 * energy);
}

TEST(Verification, V40FlickerBankIsFlatAtTheBiasInstability) {
  EXPECT_NEAR(continuous_deviation(1.0) / (kFloor * kB), 0.9981, 1e-4);
  EXPECT_NEAR(continuous_deviation(10.0) / (kFloor * kB), 0.9997, 1e-4);
  EXPECT_NEAR(continuous_deviation(100.0) / (kFloor * kB), 0.9989, 1e-4);
}

TEST(FlickerFilter, HasTheAutocovarianceOfTheBank) {
  for (double rate : {1e-7, 1e-5, 0.1, 1.0, 10.0, 200.0, 2000.0, 50000.0}) {
    const FlickerFilter f = flicker_filter(kB, rate);
    const double variance =
        static_cast<double>(kFlickerPoles) * flicker_pole_variance(kB);
    for (double lag : {0.0, 1.0, 2.0, 3.0, 10.0, 1e3, 1e5, 1e7}) {
      double bank = 0.0, filter = 0.0;
      for (std::size_t k = 0; k < kFlickerPoles; ++k)
        bank += flicker_pole_variance(kB) *
                std::exp(-lag * flicker_decay_rate(k) / rate);
      for (std::size_t i = 0; i < f.pole.size(); ++i) {
        const double mu = flicker_decay_rate(i) / rate;
        double with_now = f.direct + (lag == 0.0 ? f.direct : 0.0);
        for (std::size_t j = 0; j < f.pole.size(); ++j)
          with_now +=
              f.gain[j] / -std::expm1(-mu - flicker_decay_rate(j) / rate);
        filter += f.gain[i] * std::exp(-lag * mu) * with_now;
      }
      if (lag == 0.0) filter += f.direct * f.direct;
      EXPECT_NEAR(filter, bank, 1e-13 * variance) << rate << " Hz, lag " << lag;
    }
  }
}

TEST(FlickerFilter, HasTheAllanDeviationOfTheBankFromOneSampleTo10000Seconds) {
  for (double rate : {0.1, 1.0, 10.0, 200.0}) {
    const FlickerFilter filter = flicker_filter(kB, rate);
    for (double tau :
         {1.0 / rate, 3.0 / rate, 10.0 / rate, 30.0, 100.0, 1e3, 1e4})
      EXPECT_NEAR(filter_deviation(filter, std::lround(tau * rate)) /
                      sampled_deviation(rate, std::round(tau * rate)),
                  1.0, 1e-6)
          << rate << " Hz, " << tau << " s";
  }
}

TEST(FlickerFilter, StartsFromItsStationaryState) {
  for (double rate : {0.1, 10.0, 50000.0}) {
    const FlickerFilter f = flicker_filter(kB, rate);
    for (std::size_t i = 0; i < f.pole.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double covariance = 0.0;
        for (std::size_t n = 0; n <= j; ++n)
          covariance += f.stationary_root[i][n] * f.stationary_root[j][n];
        const double mu =
            (flicker_decay_rate(i) + flicker_decay_rate(j)) / rate;
        const double exact = f.gain[i] * f.gain[j] / -std::expm1(-mu);
        EXPECT_NEAR(covariance, exact, 1e-13 * exact) << i << " " << j;
      }
  }
}

TEST(FlickerNoise, FirstSampleHasTheVarianceOfTheBank) {
  constexpr std::uint32_t kRuns = 4000;
  double variance = 0.0;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    double first = 0.0;
    FlickerNoise(kB, 10.0, 5, 0, run).add_next(std::span(&first, 1));
    variance += first * first / kRuns;
  }
  const double exact =
      static_cast<double>(kFlickerPoles) * flicker_pole_variance(kB);
  EXPECT_NEAR(variance / exact, 1.0, 3.0 * std::sqrt(2.0 / kRuns));
}

TEST(Verification, V40FlickerHasTheBanksAllanDeviation) {
  for (double rate : {1.0, 10.0}) {
    std::vector<double> noise(2000000);
    FlickerNoise(kB, rate, 1, 0, 0).add_next(noise);
    for (std::size_t m : {1u, 3u, 10u, 100u, 1000u, 10000u}) {
      const AllanDeviation adev = allan_deviation(noise, m);
      EXPECT_NEAR(adev.value, sampled_deviation(rate, static_cast<double>(m)),
                  adev.three_sigma)
          << rate << " Hz, " << m << " samples";
    }
  }
}

TEST(FlickerFilter, RejectsBadParameters) {
  const auto message = [](double instability, double rate) {
    return rejection([&] { flicker_filter(instability, rate); });
  };
  EXPECT_EQ(message(-0.5, 10.0),
            "bias instability is -0.5 rad/s, must be 0 or more");
  EXPECT_EQ(message(NAN, 10.0),
            "bias instability is nan rad/s, must be 0 or more");
  EXPECT_EQ(message(kB, 0.0), "output rate is 0 Hz, must be above 0");
  EXPECT_EQ(message(kB, INFINITY), "output rate is inf Hz, must be above 0");
}

}  // namespace
}  // namespace beamgyro::internal::flicker_test
