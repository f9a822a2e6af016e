// SPDX-License-Identifier: MIT
#include "planning/soak_design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "compensation/inputs/input.h"
#include "planning/planner.h"
#include "planning/soak_length.h"
#include "tests/planning/small_population.h"

namespace beamgyro::internal::soak_design_test {
namespace {

const Population& population() {
  static const Population learned = small_population(60);
  return learned;
}

std::vector<double> every_kelvin() {
  std::vector<double> kelvins;
  for (int k = 0; k <= 40; ++k) kelvins.push_back(k);
  return kelvins;
}

TrainingRows rows_at(const std::vector<double>& soaks) {
  TrainingRows rows;
  const auto size = static_cast<Eigen::Index>(soaks.size());
  rows.inputs.setZero(size, 2);
  rows.bias.setZero(size);
  for (Eigen::Index k = 0; k < size; ++k)
    rows.inputs(k, 0) = soaks[static_cast<std::size_t>(k)];
  rows.temperature = rows.inputs.col(0);
  return rows;
}

TEST(SoakDesign, MeanVarianceIsThatOfTheAdaptedBias) {
  // The population's grid is the range's: the same numbers by another way,
  // equal but for rounding.
  const std::vector<double> soaks = {3.0, 17.0, 31.0};
  for (const bool bias_only : {false, true}) {
    const SoakModel model = model_of(population(), bias_only);
    const SoakDesign design(model, {every_kelvin()});
    std::vector<Input> inputs = {parse_input("temperature")};
    if (!bias_only) inputs.push_back(parse_input("quadrature"));
    const AdaptedBias adapted =
        adapted_bias(population(), inputs, rows_at(soaks), model.noise());
    const double expected = adapted.deviation.square().mean();
    EXPECT_NEAR(design.mean_variance(soaks) / expected, 1.0, 1e-6);
  }
}

TEST(Planner, FindsTheBestOfAllPairs) {
  const SoakModel model = model_of(population());
  const SoakDesign design(model, {every_kelvin()});
  double least = HUGE_VAL;
  for (const double a : every_kelvin())
    for (const double b : every_kelvin())
      if (design.is_allowed({a, b}))
        least = std::min(least, design.mean_variance({a, b}));
  const Planner planner(model, population().range(), {}, {.rows = {{5, 0.0}}});
  const auto soaks = planner.with_soaks(2).temperatures;
  // The low-rank gain and a new inverse differ by rounding.
  EXPECT_NEAR(design.mean_variance(soaks) / least, 1.0, 1e-6);
}

TEST(SoakDesign, KeepsSoaksApartAndWithinTheWay) {
  const SoakModel model = model_of(population());
  const SoakDesign design(model, {every_kelvin(), 25.0, 12.0});
  const auto soaks = design.exchanged(design.extended({}, 4));
  ASSERT_EQ(soaks.size(), 4U);
  EXPECT_TRUE(design.is_allowed(soaks));
  EXPECT_FALSE(design.is_allowed({20.0, 22.0}));
  // From 25 to 30 and to 20 are 15 K.
  EXPECT_FALSE(design.is_allowed({20.0, 30.0}));
  EXPECT_TRUE(design.is_allowed({20.0, 27.0}));
}

TEST(Planner, IsNeverWorseThanEvenSpacingAndMoreSoaksLeaveLess) {
  const SoakModel model = model_of(population());
  const SoakDesign design(model, {every_kelvin()});
  const Planner planner(model, population().range(), {}, {.rows = {{5, 0.0}}});
  double before = HUGE_VAL;
  for (std::size_t count = 1; count <= 8; ++count) {
    const SoakPlan plan = planner.with_soaks(count);
    ASSERT_EQ(plan.temperatures.size(), count);
    const double left = design.mean_variance(plan.temperatures);
    EXPECT_LE(left, design.mean_variance(even_spacing(model.range(), count)) *
                        (1.0 + 1e-9));  // rounding
    EXPECT_LT(left, before);
    before = left;
  }
}

TEST(Planner, KeepsToTheHoursAndReachesTheResidual) {
  const SoakModel model = model_of(population());
  const Planner planner(
      model, population().range(), {25.0, 1.0, 0.0},
      {.rows = std::vector<SoakRows>(30, {5, 0.0}), .minutes = 30});
  const SoakPlan quick = planner.within_hours(1.5);
  EXPECT_LE(quick.hours, 1.5);
  EXPECT_GE(quick.temperatures.size(), 2U);
  const SoakPlan free = planner.with_soaks(3);
  const SoakPlan good = planner.within_residual(free.expected.median * 1.05);
  EXPECT_LE(good.expected.median, free.expected.median * 1.05);
  EXPECT_LE(good.hours, free.hours);
  EXPECT_THROW((void)planner.within_hours(0.9), std::invalid_argument);
  EXPECT_THROW((void)planner.within_residual(1e-9), std::invalid_argument);
}

TEST(Planner, HoldsAreAsShortAsTheLagAllows) {
  const SoakModel model = model_of(population());
  // Rows from the third minute on, a lag that halves with every minute.
  std::vector<SoakRows> rows(2);
  double sum = 0.0;
  for (int count = 1; count <= 40; ++count) {
    sum += 4.0 * std::pow(0.5, count);
    rows.push_back({count, sum / count});
  }
  const Planner planner(model, population().range(), {}, {.rows = rows});
  const SoakPlan plan = planner.with_soaks(2);
  const double settled = forecast_residual(model, plan.temperatures).median;
  // From 25 degC to soaks in the cold the beam is warmer than the sensor says.
  ASSERT_LT(plan.temperatures.back(), 25.0);
  const auto minutes = static_cast<std::size_t>(plan.hold / 60);
  const auto ramp = static_cast<std::size_t>(
      std::ceil((plan.temperatures[1] - plan.temperatures[0]) / 2.0));
  const auto at = [&](std::size_t hold) {
    return forecast_residual(
               model, plan.temperatures,
               {{mean_after_ramp(rows, hold, ramp, &SoakRows::mean_lag),
                 rows[hold - 1].mean_lag},
                {}})
        .median;
  };
  EXPECT_NEAR(at(minutes), planner.judged(plan.temperatures).expected.median,
              1e-9);
  EXPECT_LE(at(minutes), settled * 1.1);
  EXPECT_GT(minutes, 7U);  // five rows
  EXPECT_GT(at(minutes - 1), at(minutes));
  EXPECT_THROW(
      Planner(model, population().range(), {}, {.rows = rows, .minutes = 6}),
      std::invalid_argument);
}

TEST(Planner, CountsTheRowAfterPowerOnOfWaysThatGoDown) {
  const SoakModel model = model_of(population());
  const StartRow row = {37.0, 0.5, 4.0};
  const auto planner = [&](std::optional<StartRow> of) {
    return Planner(model, population().range(), {38.0, 2.0, 0.0},
                   {.rows = {{5, 0.0}}, .start_row = of});
  };
  const SoakPlan with = planner(row).with_soaks(2);
  ASSERT_TRUE(has_start_row(with.temperatures, 38.0, row));
  const auto [low, high] =
      std::pair{with.temperatures[0], with.temperatures[1]};
  EXPECT_EQ(with.expected.median,
            forecast_residual(model, {low, high, 37.0}, {{0.0, 0.0, 0.5}, {}})
                .median);
  // The row tells what a soak near it would.
  EXPECT_LE(high, 37.0 - kLeastDistance);
  const SoakDesign shown(
      model, {.candidates = every_kelvin(), .start = 38.0, .start_row = row});
  const auto without = planner({}).with_soaks(2).temperatures;
  EXPECT_LT(shown.mean_variance({low, high}),
            SoakDesign(model, {every_kelvin()}).mean_variance(without));
  EXPECT_FALSE(shown.is_allowed({38.0, 10.0}));
}

TEST(SoakDesign, ARootIsAsOfAPopulationOfThatCovariance) {
  // Modes twice as large, or a root that doubles them.
  const Population small = small_population(40);
  Population large = small;
  large.modes *= 2.0;
  const Eigen::Index modes = small.modes.cols();
  const SoakModelOptions options = {.range = small.range(),
                                    .noise = PointNoise{.channel_share = 1e9},
                                    .bias_only = true};
  const SoakModel model(small, same_temperature, options);
  const SoakModel doubled(large, same_temperature, options);
  const std::vector<double> soaks = {5.0, 33.0};
  EXPECT_NEAR(
      SoakDesign(model, {soaks}, 2.0 * Eigen::MatrixXd::Identity(modes, modes))
          .mean_variance(soaks),
      SoakDesign(doubled, {soaks}).mean_variance(soaks), 1e-9);
}

TEST(Planner, ForecastsFewDevicesBySoaksThatWereChosenWithoutThem) {
  const Population few = small_population(20);
  const SoakModel model = model_of(few, true);
  const Planner planner(model, few.range(), {}, {.rows = {SoakRows{5, 0.0}}});
  const SoakPlan plan = planner.with_soaks(2);
  ASSERT_EQ(plan.of_folds.size(), kFolds);
  // A device of each fold, among the four others of which nobody knows it.
  const ResidualDraws same = residual_draws(model, plan.temperatures);
  ResidualDraws nested = same;
  for (std::size_t k = 0; k < kFolds; ++k)
    take_fold(residual_draws(model, plan.of_folds[k]), {k, kFolds}, nested);
  EXPECT_NEAR(plan.expected.median, forecast_of(nested).median, 1e-9);
  EXPECT_NE(plan.expected.median, forecast_of(same).median);
  for (std::size_t k = 0; k < nested.rms.size(); ++k)
    if (plan.of_folds[k % 20 % kFolds] == plan.temperatures) {
      EXPECT_EQ(nested.rms[k], same.rms[k]);
    }
  // Soaks that somebody else chose have seen no device.
  EXPECT_EQ(planner.judged(plan.temperatures).expected.median,
            forecast_of(same).median);
}

TEST(Planner, CountsTheNoiseOfTheTemperatureWhereTheBiasIsSteep) {
  // What 0.1 K makes of the slope is as much noise of each soak.
  const SoakModel model = model_of(population(), true);
  const std::vector<double> soaks = {5.0, 33.0};
  const Eigen::VectorXd slope = model.slope(soaks);
  EXPECT_GT(slope(0), 2.0 * slope(1));  // steep in the cold
  const auto median = [&](const std::vector<double>& at, double temperature) {
    return Planner(model, population().range(), {},
                   {.rows = {SoakRows{5, 0.0}},
                    .noise = SlowNoise{.own = 0.01},
                    .temperature_noise = temperature})
        .judged(at)
        .expected.median;
  };
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(2, 5);
  for (Eigen::Index k = 0; k < 2; ++k)
    noise(k, 3 + k) = std::hypot(0.01, 0.1 * slope(k));
  EXPECT_NEAR(median(soaks, 0.1),
              forecast_residual(model, soaks, {{0.0, 0.0}, noise}).median,
              1e-9);
  // Of so few soaks something else is left; of many it is the noise.
  const std::vector<double> many = {0, 5, 10, 15, 20, 25, 30, 35, 40};
  EXPECT_GT(median(many, 0.1), 1.2 * median(many, 0.0));
}

TEST(SoakModel, RefusesARangeThatThePopulationDoesNotKnow) {
  EXPECT_THROW(
      SoakModel(population(), same_temperature, {.range = {-5.0, 40.0}}),
      std::invalid_argument);
  EXPECT_THROW((void)model_of(population()).equations({41.0}),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::soak_design_test
