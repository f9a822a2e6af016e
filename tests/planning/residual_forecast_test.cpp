// SPDX-License-Identifier: MIT
#include "planning/residual_forecast.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/soak_design.h"
#include "planning/soak_model.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/planning/small_population.h"

namespace beamgyro::internal::residual_forecast_test {
namespace {

using Eigen::VectorXd;

TEST(ResidualForecast, OfDevicesIsThatOfPopulationsWithoutThem) {
  // Three devices, so that the median over devices and draws of a soak without
  // noise is a single device's: computed here from the two others.
  Population few = small_population(3);
  const SoakModel model = {
      few,
      same_temperature,
      {.range = few.range(),
       .noise = PointNoise{.bias = 1e3, .channel_share = 1e3}}};
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
  // A quantile q of probability p scatters by sqrt(p (1 - p)/n)/(q f(q)), most
  // for the size of a single normal number: by 4.1 % at the median and 3.4 % at
  // 95 % of 800 devices, 1.9 and 1.5 % of the 4000 draws of the process. Two
  // standard deviations and a half of the two together are 11 and 9 %.
  EXPECT_NEAR(devices.median / process.median, 1.0, 0.1);
  EXPECT_NEAR(devices.p95 / process.p95, 1.0, 0.09);
}

TEST(ResidualForecast, OfDevicesKnowsTailsThatTheProcessDoesNot) {
  // Half of the devices differ by 0.3 of what they would, half by 1.7. Without
  // a soak that tells anything the residual follows them.
  Population tails = small_population(800, true);
  const auto forecast = [&](const Population& population) {
    return forecast_residual(
        SoakModel(population, same_temperature,
                  {.range = population.range(),
                   .noise = PointNoise{.bias = 1e3, .channel_share = 1e3}}),
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

TEST(ResidualForecast, GrowsWithALagOfTheBeam) {
  const SoakModel model = model_of(small_population(50));
  const std::vector<double> soaks = {5.0, 33.0};
  const double settled = forecast_residual(model, soaks).median;
  EXPECT_EQ(forecast_residual(model, soaks, {{0.0, 0.0}, {}}).median, settled);
  EXPECT_GT(forecast_residual(model, soaks, {{3.0, 3.0}, {}}).median,
            1.01 * settled);
}

TEST(ResidualForecast, HysteresisIsCountedBothWays) {
  Population few = small_population(3);
  // The soak tells nothing, so that the residual is the distance from the
  // others' mean and, on either way, half of what the ways differ by.
  const SoakModelOptions deaf = {
      .range = few.range(),
      .noise = PointNoise{.bias = 1e3, .channel_share = 1e3}};
  const auto median = [&] {
    return forecast_residual(SoakModel(few, same_temperature, deaf), {20.0},
                             {{}, {}, {1.0}})
        .median;
  };
  const double without = median();
  few.hysteresis = Eigen::MatrixXd::Constant(3, few.grid(), 0.5);
  // Less the noise of a point of each of the two sweeps, half of it.
  const double half = 0.5 * std::sqrt(1.0 - 2.0 * 0.03 * 0.03);
  EXPECT_NEAR(median(), std::hypot(without, half), 1e-3);
  // A constant through one soak is moved by it: up after a way down. Over both
  // directions of the check the squares of the two differ by the cross term
  // only, which changes its sign with the way.
  const auto square = [&](double way) {
    const double rms =
        straight_line_draws(model_of(few), {20.0},
                            {{}, Eigen::MatrixXd::Zero(1, 1), {way}})
            .rms[0];
    return rms * rms;
  };
  const double down = square(1.0), up = square(-1.0);
  few.hysteresis.setZero();
  EXPECT_NEAR(0.5 * (down + up), square(1.0) + 2 * half * half, 1e-9);
}

TEST(ResidualForecast, TurnOnStaysWhereIndependentNoiseAveragesOut) {
  const SoakModel model = model_of(small_population(200), true);
  const std::vector<double> soaks = {0.0,  5.0,  10.0, 15.0, 20.0,
                                     25.0, 30.0, 35.0, 40.0};
  const auto forecast = [&](const SlowNoise& noise) {
    return forecast_residual(
               model, soaks,
               {{}, slow_noise_root(noise, soaks, {20.0, 2.0, 600.0})})
        .p95;
  };
  // 95 % of |N(0, 0.03)| are below 0.059, of the mean of nine below 0.020; the
  // curve has four modes, which take up less than half of the offset.
  EXPECT_GT(forecast({.turn_on = 0.03}), 1.2 * forecast({.own = 0.03}));
}

std::vector<double> every_kelvin() {
  std::vector<double> soaks;
  for (int T = 0; T <= 40; ++T) soaks.push_back(T);
  return soaks;
}

TEST(StraightLines, ThroughEveryTemperatureLeaveTheNoiseOfTheSoaksAlone) {
  const SoakModel model = model_of(small_population(50));
  const std::vector<double> soaks = every_kelvin();
  const auto draws = [&](const SlowNoise& noise) {
    return straight_line_draws(
        model, soaks, {{}, slow_noise_root(noise, soaks, {20.0, 2.0, 600.0})});
  };
  EXPECT_LT(std::ranges::max(draws({.own = 1e-9}).rms), 1e-8);
  // Of an offset of all soaks the median is 0.6745 sigma: of 4,000 draws within
  // 4 %, three standard deviations.
  EXPECT_NEAR(forecast_of(draws({.turn_on = 0.03})).median, 0.6745 * 0.03,
              0.04 * 0.6745 * 0.03);
}

TEST(StraightLines, OneSoakIsAConstant) {
  const Population few = small_population(3);
  const SoakModel model = model_of(few);
  const ResidualDraws found = straight_line_draws(
      model, {20.0}, {{}, Eigen::MatrixXd::Constant(1, 1, 1e-12)});
  const SoakModel::Bias all = model.bias(every_kelvin(), std::vector(41, 0.0));
  for (Eigen::Index d = 0; d < 3; ++d) {
    const VectorXd t = model.truth() * few.coefficients.row(d).transpose();
    VectorXd curve = all.mean + all.modes * t;
    curve.array() -= curve(20);
    EXPECT_NEAR(found.rms[static_cast<std::size_t>(d)],
                curve.norm() / std::sqrt(41.0), 1e-9);
  }
}

TEST(SlowNoiseRoot, WalksInTheOrderOfTheVisits) {
  // From 20 degC first to 30, then to 0: an hour of hold each, 10 K and 30 K.
  const Eigen::MatrixXd L = slow_noise_root(
      {.turn_on = 0.03, .walk = 1e-3, .own = 0.01}, {0.0, 30.0}, {20, 2, 3600});
  const Eigen::MatrixXd covariance = L * L.transpose();
  const double first = 1e-6 * (300 + 3600), own = 1e-4, turn_on = 9e-4;
  EXPECT_NEAR(covariance(1, 1), turn_on + first + own, 1e-12);
  EXPECT_NEAR(covariance(0, 1), turn_on + first, 1e-12);
  EXPECT_NEAR(covariance(0, 0), turn_on + first + 1e-6 * (900 + 3600) + own,
              1e-12);
}

// Smooth curves of unit variance, in all directions a little, and in the bias
// the noise of a walk with steps of `step` [deg/s].
Eigen::MatrixXd smooth_covariance(Eigen::Index grid, double step) {
  Eigen::MatrixXd covariance(2 * grid, 2 * grid);
  for (Eigen::Index i = 0; i < 2 * grid; ++i)
    for (Eigen::Index j = 0; j < 2 * grid; ++j) {
      const double distance = static_cast<double>(i - j) / 4.0;
      covariance(i, j) = std::exp(-distance * distance);
      if (i == j) covariance(i, j) += 1e-6;
      if (i < grid && j < grid)
        covariance(i, j) += step * step * static_cast<double>(std::min(i, j));
    }
  return covariance;
}

TEST(TruthRoot, TakesOffTheWalkAndNoMore) {
  Population p = small_population(40);
  p.modes = reference::cholesky_root(smooth_covariance(p.grid(), 0.5));
  const Eigen::MatrixXd R = truth_root(p);
  const Eigen::MatrixXd found = p.modes * R * R * p.modes.transpose();
  // Steps of 0.5 deg/s add up to a variance of 10. What the curves have in all
  // directions, 1e-6, is all that can be taken for a walk.
  const Eigen::MatrixXd clean = smooth_covariance(p.grid(), 0.0);
  EXPECT_LT((found - clean).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(TruthRoot, KeepsCurvesWithoutDirectionsOfNoise) {
  const Population smooth = small_population(60);
  const Eigen::MatrixXd R = truth_root(smooth);
  EXPECT_LT((R - Eigen::MatrixXd::Identity(R.rows(), R.cols())).norm(), 1e-12);
}

// Curves of `clean` covariance, and sweeps of an hour from end to end.
Population swept_population(const Eigen::MatrixXd& shown, double sweeps) {
  Population p = small_population(40);
  p.modes = reference::cholesky_root(shown);
  p.sweeps = {sweeps, 3600.0 / 40.0};
  return p;
}

TEST(TruthRoot, TakesOffTheNoiseOfTheSweepsWhateverTheDevicesShow) {
  // Steps of 0.05 deg/s, by sqrt(90 s), and two sweeps of each device, which
  // are averaged. In the direction in which these devices differ least it is
  // by 1e-4 of a step only, as of few devices it may be.
  const double step = 0.05;
  const Eigen::Index grid = small_population(40).grid();
  const Eigen::MatrixXd clean = smooth_covariance(grid, 0.0);
  const Population p =
      swept_population(smooth_covariance(grid, step / std::sqrt(2.0)), 2.0);
  const Eigen::MatrixXd R =
      truth_root(p, SlowNoise{.walk = step / std::sqrt(90.0)});
  const Eigen::MatrixXd found = p.modes * R * R * p.modes.transpose();
  EXPECT_LT((found - clean).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(TruthRoot, TakesOffTheNoiseOfFewerModesThanValues) {
  // Two modes: a constant, of which 0.3 of 0.5 deg/s are the turn-on offset,
  // and a slope that no noise has.
  Population p = small_population(40);
  p.modes.setZero(p.modes.rows(), 2);
  p.modes.col(0).head(p.grid()).setConstant(0.5);
  p.modes.col(1).head(p.grid()).setLinSpaced(-1.0, 1.0);
  p.sweeps = {1.0, 90.0};
  const Eigen::MatrixXd R = truth_root(p, SlowNoise{.turn_on = 0.3});
  EXPECT_NEAR(R(0, 0) * 0.5, 0.4, 1e-9);
  EXPECT_NEAR(R(1, 1), 1.0, 1e-9);
  EXPECT_NEAR(R(0, 1), 0.0, 1e-9);
  // More noise than the devices differ by leaves nothing true of it.
  EXPECT_NEAR(truth_root(p, SlowNoise{.turn_on = 0.8})(0, 0), 0.0, 1e-9);
}

TEST(ResidualForecast, IsTheSameEveryTime) {
  const SoakModel model = model_of(small_population(40));
  EXPECT_EQ(forecast_residual(model, {5.0, 20.0}).p95,
            forecast_residual(model, {5.0, 20.0}).p95);
}

}  // namespace
}  // namespace beamgyro::internal::residual_forecast_test
