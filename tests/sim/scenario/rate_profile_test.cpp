// SPDX-License-Identifier: MIT
#include "sim/scenario/rate_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamgyro::internal::rate_profile_test {
namespace {

TEST(RandomRate, HasTheRmsAndTheCorrelationItSays) {
  constexpr double kRms = 0.3, kBandwidth = 5, kDuration = 4000;
  const PiecewiseLinear rate = realised({kRms, kBandwidth}, kDuration, 3, 0, 0);
  const double h = 1 / (16 * kBandwidth);  // grid of the exact samples [s]
  const double w =
      2 * std::numbers::pi * kBandwidth / std::sqrt(std::sqrt(2.0) - 1);
  const auto samples = [&](double step) {
    std::vector<double> x;
    for (double t = 0; t < kDuration; t += step) x.push_back(rate.value(t));
    return x;
  };
  const auto correlation = [](const std::vector<double>& x, std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum / static_cast<double>(x.size() - lag) / (kRms * kRms);
  };
  // A record of T seconds with correlation time 1.25/w knows its variance to
  // sqrt(2 x 1.25 / (w T)), 0.4 %: three sigma.
  EXPECT_NEAR(correlation(samples(h / 7.3), 0), 1, 0.012);
  const std::vector<double> grid = samples(h);
  for (const std::size_t lag : {1u, 2u, 5u, 10u}) {
    const double wt = w * h * static_cast<double>(lag);
    EXPECT_NEAR(correlation(grid, lag) / correlation(grid, 0),
                std::exp(-wt) * (1 + wt), 0.012)
        << lag;
  }
}

TEST(RandomRate, DependsOnSeedDeviceAndRunOnly) {
  const RandomRate random{0.1, 2};
  const double value = realised(random, 10, 1, 2, 3).value(5);
  EXPECT_EQ(realised(random, 100, 1, 2, 3).value(5), value);
  EXPECT_NE(realised(random, 10, 4, 2, 3).value(5), value);
  EXPECT_NE(realised(random, 10, 1, 4, 3).value(5), value);
  EXPECT_NE(realised(random, 10, 1, 2, 4).value(5), value);
}

TEST(Signal, IsShownUnfilteredAndFiltered) {
  const std::vector<double> times = {0, 0.01, 0.02, 0.03, 0.04};
  const Signal step = PiecewiseLinear({0, 0.02, 0.02}, {0, 0, 1});
  EXPECT_EQ(values_at(step, times), (std::vector<double>{0, 0, 1, 1, 1}));
  const double w = 2 * std::numbers::pi * 60;
  const std::vector<double> filtered =
      OutputFilter(w).response(step, 100, times.size());
  EXPECT_NEAR(filtered[2], 0, 1e-12);
  EXPECT_NEAR(filtered[3], 1 - std::exp(-w * 0.01) * (1 + w * 0.01), 1e-12);
}

}  // namespace
}  // namespace beamgyro::internal::rate_profile_test
