// SPDX-License-Identifier: MIT
#include "planning/residual_forecast.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/soak_design.h"
#include "tests/planning/small_population.h"

namespace beamgyro::residual_forecast_test {
namespace {

using Eigen::VectorXd;

TEST(ResidualForecast, OfDevicesIsThatOfPopulationsWithoutThem) {
  // Three devices, so that the median over devices and draws of a soak without
  // noise is a single device's: computed here from the two others.
  Population few = small_population(3);
  const SoakModel model = {
      few,
      same_temperature,
      {.range = few.range(), .noise = {.bias = 1e3, .channel_share = 1e3}}};
  // The soak tells nothing: the residual is the distance from the others' mean.
  std::vector<double> expected;
  for (Eigen::Index d = 0; d < 3; ++d) {
    const VectorXd others =
        (few.coefficients.colwise().sum() - few.coefficients.row(d)) / 2.0;
    const VectorXd x = few.coefficients.row(d).transpose() - others;
    expected.push_back(std::sqrt(x.dot(model.weight() * x)));
  }
  std::ranges::sort(expected);
  // Coefficients are stored to 1e-4, and the soak tells a millionth.
  EXPECT_NEAR(forecast_residual(model, {20.0}).median / expected[1], 1.0, 2e-3);
}

TEST(ResidualForecast, OfDevicesAgreesWithTheProcessWhereItIsGaussian) {
  Population many = small_population(800);
  ASSERT_EQ(forecast_basis(many), ForecastBasis::kDevices);
  const std::vector<double> soaks = {2.0, 20.0};
  const ResidualForecast devices = forecast_residual(model_of(many), soaks);
  many.coefficients.resize(0, 0);
  ASSERT_EQ(forecast_basis(many), ForecastBasis::kGaussian);
  const ResidualForecast process = forecast_residual(model_of(many), soaks);
  // Of 800 devices the quantiles scatter by 3 to 6 % (1 sigma).
  EXPECT_NEAR(devices.median / process.median, 1.0, 0.1);
  EXPECT_NEAR(devices.p95 / process.p95, 1.0, 0.2);
}

TEST(ResidualForecast, OfDevicesKnowsTailsThatTheProcessDoesNot) {
  // Half of the devices differ by 0.3 of what they would, half by 1.7. Without
  // a soak that tells anything the residual follows them.
  Population tails = small_population(800, true);
  const auto forecast = [&](const Population& population) {
    return forecast_residual(
        SoakModel(population, same_temperature,
                  {.range = population.range(),
                   .noise = {.bias = 1e3, .channel_share = 1e3}}),
        {20.0});
  };
  const ResidualForecast devices = forecast(tails);
  tails.coefficients.resize(0, 0);
  const ResidualForecast process = forecast(tails);
  EXPECT_LT(devices.median, 0.8 * process.median);
  EXPECT_GT(devices.p95, 1.1 * process.p95);
}

TEST(ResidualForecast, OfTheProcessHasTheVarianceOfTheDesign) {
  Population many = small_population(50);
  many.coefficients.resize(0, 0);
  const SoakModel model = model_of(many);
  const std::vector<double> soaks = {5.0, 33.0};
  const double rms =
      std::sqrt(SoakDesign(model, {{5.0, 33.0}}).mean_variance(soaks));
  const ResidualForecast found = forecast_residual(model, soaks);
  // The root of a mean square lies between these quantiles of any sum of
  // squares of normal numbers.
  EXPECT_LT(found.median, rms);
  EXPECT_GT(found.p90, rms);
  EXPECT_GT(found.p95, found.p90);
}

TEST(ResidualForecast, IsTheSameEveryTime) {
  const SoakModel model = model_of(small_population(40));
  EXPECT_EQ(forecast_residual(model, {5.0, 20.0}).p95,
            forecast_residual(model, {5.0, 20.0}).p95);
}

}  // namespace
}  // namespace beamgyro::residual_forecast_test
