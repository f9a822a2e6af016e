// SPDX-License-Identifier: MIT
#include "compensation/export/export_sitl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace beamgyro::internal::export_sitl_test {
namespace {

std::vector<double> seconds(std::size_t count) {
  std::vector<double> times(count);
  for (std::size_t k = 0; k < count; ++k) times[k] = static_cast<double>(k);
  return times;
}

std::vector<double> lag(double start, double end, double tau,
                        const std::vector<double>& times) {
  std::vector<double> T;
  for (const double t : times)
    T.push_back(end - (end - start) * std::exp(-t / tau));
  return T;
}

TEST(ExportSitl, FindsTheLagThatMadeTheTemperatures) {
  const std::vector<double> times = seconds(3600);
  for (const double tau : {5.0, 300.0, 2000.0, 20000.0}) {
    for (const double start : {-40.0, 60.0}) {
      const WarmUpFit fit = fit_warm_up(times, lag(start, 25, tau, times));
      // The search for tau ends within the rounding of the residual.
      EXPECT_NEAR(fit.time_constant, tau, 1e-4 * tau);
      EXPECT_NEAR(fit.start, start, 1e-4);
      EXPECT_NEAR(fit.end, 25, 1e-3);
      EXPECT_LT(fit.largest, 1e-4);
      EXPECT_NEAR(warm_up_temperature(fit, 0), start, 1e-4);
    }
  }
}

TEST(ExportSitl, StatesTheResidualOfTwoLags) {
  const std::vector<double> times = seconds(3600);
  std::vector<double> T = lag(20, 25, 60, times);
  const std::vector<double> slow = lag(0, 5, 900, times);
  for (std::size_t k = 0; k < T.size(); ++k) T[k] += slow[k];
  const WarmUpFit fit = fit_warm_up(times, T);
  double squares = 0, largest = 0;
  for (std::size_t k = 0; k < T.size(); ++k) {
    const double left = T[k] - warm_up_temperature(fit, times[k]);
    squares += left * left;
    largest = std::max(largest, std::abs(left));
  }
  EXPECT_NEAR(fit.rms, std::sqrt(squares / 3600), 1e-12);
  EXPECT_NEAR(fit.largest, largest, 1e-12);
  EXPECT_GT(fit.largest, 0.1);
  EXPECT_GT(fit.time_constant, 60);
  EXPECT_LT(fit.time_constant, 900);
}

TEST(ExportSitl, ASteadyTemperatureIsTheDefaultOfSitl) {
  const std::vector<double> times = seconds(100);
  const WarmUpFit fit = fit_warm_up(times, std::vector<double>(100, -7.5));
  EXPECT_EQ(fit.start, -7.5);
  EXPECT_EQ(fit.end, -7.5);
  EXPECT_EQ(fit.time_constant, 300);
  EXPECT_EQ(fit.largest, 0);
}

TEST(ExportSitl, RefusesTooFewSamples) {
  EXPECT_THROW(fit_warm_up(seconds(9), seconds(9)), std::invalid_argument);
  EXPECT_THROW(fit_warm_up(seconds(20), seconds(10)), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::export_sitl_test
