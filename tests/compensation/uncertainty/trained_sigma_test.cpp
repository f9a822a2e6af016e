// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "compensation/methods/population.h"
#include "compensation/models/bias_function.h"
#include "compensation/training/sigma_fit.h"
#include "compensation/training/train.h"
#include "compensation/uncertainty/sigma_calibration.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::trained_sigma_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

using Names = std::vector<std::string>;

constexpr double kNormalHalfWidth = 1.645;  // of 90 %

const std::vector<Input> kTemperatureInput = {parse_input("temperature")};

// Soaks of an hour every 10 K with ramps of 10 min. Each soak has an offset of
// its own, each run another one; the bias lags.
Recording soak_run(std::uint32_t run, double lag) {
  const std::vector<double> offsets = white(20, run);
  RecordedRun one{.duration = 10 * 4200.0, .step = 10.0};
  one.temperature = [](double t) {
    const double soak = std::floor(t / 4200.0);
    const double ramp = std::max(t - 4200.0 * soak - 3600.0, 0.0);
    return -40.0 + 10.0 * (soak + ramp / 600.0);
  };
  one.bias = [=, T = one.temperature](double t) {
    const auto soak = static_cast<std::size_t>(t / 4200.0);
    const double rate = t - 4200.0 * double(soak) > 3600.0 ? 10.0 / 600.0 : 0.0;
    return 0.5 + 0.02 * T(t) + 0.05 * offsets[soak] + lag * rate;
  };
  return one.recording();
}

std::vector<TrainingRun> soak_runs(int count, std::uint32_t first,
                                   double lag = 4.0) {
  std::vector<TrainingRun> result;
  for (int k = 0; k < count; ++k) {
    const std::string name = std::to_string(first) + std::to_string(k);
    result.push_back({name + ".h5", name,
                      soak_run(first + static_cast<std::uint32_t>(k), lag)});
  }
  return result;
}

ModelSpec line_spec() {
  return {.inputs = kTemperatureInput,
          .rows = {60.0, 0.05},
          .kind = PolynomialSpec{1}};
}

// Share of the samples within the 90 % interval.
double covered_share(const FittedCompensator& c, const Recording& recording) {
  const std::vector<double> rate = compensated_rate(c, recording);
  const std::vector<double> sigma = compensated_rate_sigma(c, recording);
  double covered = 0.0;
  for (std::size_t k = 0; k < rate.size(); ++k)
    if (std::abs(rate[k]) <= kNormalHalfWidth * sigma[k]) covered += 1.0;
  return covered / static_cast<double>(rate.size());
}

TEST(TrainedSigma, OfALineIsTheSpreadOfSoaksWhenNothingIsHeldOut) {
  const FittedCompensator c =
      train(line_spec(), soak_runs(3, 10), {}, 1).compensator;
  ASSERT_TRUE(c.sigma);
  EXPECT_EQ(c.sigma->source, SigmaSource::kResiduals);
  // 30 soaks of 0.05 deg/s: their deviation is known to 13 %, and a line
  // through them adds 2 / 30 of the variance.
  EXPECT_NEAR(c.sigma->factor * c.sigma->curve_at(0.0), 0.05, 0.02);
  ASSERT_TRUE(c.sigma->temperature_rate);
  EXPECT_GT(c.sigma->temperature_rate->amplitude, 2.0);
}

TEST(TrainedSigma, IsWiderWhereTheFitIsLessSure) {
  const FittedCompensator c =
      train(line_spec(), soak_runs(1, 20), soak_runs(2, 21), 1).compensator;
  ASSERT_TRUE(c.sigma);
  EXPECT_EQ(c.sigma->source, SigmaSource::kCovariance);
  const ArrayXd& T = c.sigma->curve.temperatures;
  const double lowest = T(0), highest = T(T.size() - 1);
  for (const double d : {1.0, 10.0, 50.0}) {
    EXPECT_GT(c.sigma->curve_at(lowest - d), c.sigma->curve_at(lowest));
    EXPECT_GT(c.sigma->curve_at(highest + d), c.sigma->curve_at(highest));
  }
  // A bias of 0.02 deg/s/K that is clamped leaves 1 deg/s at 50 K.
  EXPECT_GT(c.sigma->at(highest + 50.0, 0.0, 0.0), 0.99);
}

TEST(TrainedSigma, HeldOutRunsCalibrateIt) {
  const FittedCompensator c =
      train(line_spec(), soak_runs(2, 30), soak_runs(12, 40), 1).compensator;
  ASSERT_TRUE(c.sigma);
  EXPECT_EQ(c.sigma->calibration.by, "run");
  EXPECT_EQ(c.sigma->calibration.groups, 12U);
  EXPECT_EQ(c.sigma->calibration.level, kSigmaLevel);
  // A clamped bias of 0.02 deg/s/K leaves 1 deg/s at 50 K, whatever the factor.
  const ArrayXd& T = c.sigma->curve.temperatures;
  EXPECT_NE(c.sigma->factor, 1.0);
  EXPECT_NEAR(c.sigma->at(T(T.size() - 1) + 50.0, 0.0, 0.0), 1.0, 0.1);
  double share = 0.0;
  for (const TrainingRun& run : soak_runs(12, 60))
    share += covered_share(c, run.recording) / 12.0;
  // 120 unseen soaks: 0.9 +- 0.027, and as much of the 120 calibrated on.
  EXPECT_NEAR(share, 0.9, 0.08);
}

TEST(TrainedSigma, ConstantsAndThermistorsHaveNone) {
  ModelSpec spec = line_spec();
  spec.kind = ConstantSpec{};
  EXPECT_FALSE(
      train(spec, soak_runs(1, 80), soak_runs(2, 81), 1).compensator.sigma);
}

// Student's t of one run would be 3.8 times as wide.
TEST(TrainedSigma, OfATableIsNotKnownFromOneHeldOutRun) {
  ModelSpec spec = line_spec();
  spec.kind = TableSpec{};
  const TrainResult one = train(spec, soak_runs(1, 90), soak_runs(1, 91), 1);
  EXPECT_FALSE(one.compensator.sigma);
  EXPECT_EQ(one.compensator.sigma_not_known,
            "one held-out run does not tell how runs differ: expected two or "
            "more, or one of several power cycles or legs");
  EXPECT_EQ(one.sigma_remarks,
            Names{"no sigma: " + one.compensator.sigma_not_known});
}

// Soaks of one run share its turn-on offset, and so does the curve.
TEST(TrainedSigma, OfALineIsNotKnownFromOneRun) {
  const FittedCompensator alone =
      train(line_spec(), soak_runs(1, 20), {}, 1).compensator;
  EXPECT_FALSE(alone.sigma);
  EXPECT_EQ(alone.sigma_not_known,
            "one leg of one run does not tell how the next run differs, in "
            "turn-on offset, slow noise or lag: expected two runs or more, or "
            "two held-out ones");
  const FittedCompensator one =
      train(line_spec(), soak_runs(1, 20), soak_runs(1, 21), 1).compensator;
  EXPECT_FALSE(one.sigma);
  EXPECT_EQ(one.sigma_not_known,
            "one held-out run does not tell how runs differ: expected two or "
            "more, or one of several power cycles or legs");
  const FittedCompensator two =
      train(line_spec(), soak_runs(1, 20), soak_runs(2, 21), 1).compensator;
  ASSERT_TRUE(two.sigma);
  EXPECT_EQ(two.sigma->calibration.groups, 2U);
  EXPECT_EQ(two.sigma_not_known, "");
}

TEST(TrainedSigma, ATableHasOneFromRowsItHasNotSeen) {
  ModelSpec spec = line_spec();
  spec.kind = TableSpec{};
  const TrainResult alone = train(spec, soak_runs(1, 90), {}, 1);
  EXPECT_FALSE(alone.compensator.sigma);
  EXPECT_EQ(alone.compensator.sigma_not_known,
            "it takes residuals of held-out runs, or of groups that "
            "cross-validation leaves out");
  const FittedCompensator c =
      train(spec, soak_runs(1, 90), soak_runs(2, 91), 1).compensator;
  ASSERT_TRUE(c.sigma);
  EXPECT_EQ(c.sigma->source, SigmaSource::kResiduals);
  EXPECT_EQ(c.sigma->calibration.groups, 2U);
  EXPECT_EQ(c.sigma->calibration.level, 0.0);
}

TEST(TrainedSigma, OfACurveTellsOfOneDeviceOfASetAndNotOfSeveral) {
  std::vector<TrainingRun> runs = soak_runs(2, 70);
  for (TrainingRun& run : runs) run.device = "7";
  RunSource source = source_of(runs);
  source.set = TrainingSet{"set", "sha", 1, 1};
  const std::vector<TrainingRun> none;
  EXPECT_TRUE(train(line_spec(), source, source_of(none), 1).compensator.sigma);
  runs[1].device = "8";
  EXPECT_FALSE(
      train(line_spec(), source, source_of(none), 1).compensator.sigma);
}

// Too few rows of the others are a cause, and any other failure is a failure.
TEST(LeftOutSigma, SaysWhyThereIsNone) {
  const auto sigma = [](const FitSpec& kind, const TrainingRows& rows) {
    return left_out_sigma(kind, kTemperatureInput, rows,
                          ArrayXd::Constant(1, 20.0), 1);
  };
  const auto bias = [](double T, int) { return 0.1 * T; };
  const TrainingRows two =
      rows_of({{0, 0, 20.0, 20.0, 9}, {0, 0, 30.0, 30.0, 9}}, bias);
  EXPECT_THROW(sigma(PolynomialSpec{1}, two), UndeterminedFit);
  const TrainingRows three = rows_of(
      {{0, 0, 20.0, 20.0, 9}, {0, 0, 25.0, 25.0, 9}, {0, 0, 29.0, 29.0, 9}},
      bias);
  EXPECT_THROW(sigma(PolynomialSpec{2}, three), UndeterminedFit);
  try {
    sigma(ArduPilotSpec{}, three);
    ADD_FAILURE() << "a calibration of 9 K was accepted";
  } catch (const UndeterminedFit& error) {
    ADD_FAILURE() << error.what();
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(holds(error.what(), "ArduPilot"));
  }
}

TEST(TrainedSigma, IsTheSameForTheSameRuns) {
  const auto text = [] {
    const FittedCompensator c =
        train(line_spec(), soak_runs(2, 30), soak_runs(3, 40), 1).compensator;
    return c.sigma->curve.values;
  };
  EXPECT_TRUE((text() == text()).all());
}

TEST(SoakGroups, AreStretchesWithinTwoKelvinsOfACycle) {
  const RowGroups groups = soak_groups(rows_of(
      {{0, 0, 20.0, 20.0, 5}, {0, 0, 30.0, 35.9, 60}, {0, 1, 35.9, 36.0, 4}},
      [](double, int) { return 0.0; }));
  EXPECT_EQ(groups.count, 5);
  EXPECT_EQ(groups.of_row(4), 0);
  EXPECT_EQ(groups.of_row(5), 1);
  EXPECT_EQ(groups.of_row(64), 3);
  EXPECT_EQ(groups.of_row(65), 4);
}

TEST(LocalRms, IsThatOfThePointsNearby) {
  const ArrayXd T = ArrayXd::LinSpaced(81, -40.0, 40.0);
  const ArrayXd squares = (T < 0.0).select(ArrayXd::Constant(81, 0.01), 0.09);
  const ArrayXd found = local_rms(T, squares, ArrayXd{{-35.0, 0.0, 35.0}});
  EXPECT_NEAR(found(0), 0.1, 0.07);
  EXPECT_NEAR(found(1), std::sqrt(0.05), 0.01);
  EXPECT_NEAR(found(2), 0.3, 0.03);
  EXPECT_LT(found(0), found(1));
  EXPECT_LT(found(1), found(2));
  EXPECT_NEAR(local_rms(T, ArrayXd::Constant(81, 0.04), T)(13), 0.2, 1e-12);
}

// Devices of a parabola each: b = c_0 + c_1 T / 45 + c_2 (T / 45)^2.
TrainingRows parabolas(int devices, std::uint32_t stream,
                       const std::vector<double>& temperatures) {
  const std::vector<double> c = white(3 * devices, stream);
  std::vector<Leg> legs;
  for (int d = 0; d < devices; ++d)
    for (const double T : temperatures) legs.push_back({d, d, T, T, 2});
  const auto rows_each = static_cast<int>(2 * temperatures.size());
  return rows_of(legs, [&](double T, int row) {
    const auto d = 3 * static_cast<std::size_t>(row / rows_each);
    const double x = T / 45.0;
    return c[d] + 0.5 * c[d + 1] * x + 0.5 * c[d + 2] * x * x;
  });
}

// Nothing tells the slope beyond the range: the steepest within it stands for
// it, that of a device of the population where the own curve is flat.
TEST(AdaptedSigma, GrowsByTheSteepestBiasOfThePopulation) {
  const Population population = fit_population(
      kTemperatureInput, parabolas(200, 3, every_five_kelvins()), 5.0);
  // c_1 / 90 + T c_2 / 2025, largest at 50 degC; 200 devices tell it to 5 %.
  EXPECT_NEAR(steepest_bias(population), std::hypot(1.0 / 90, 47.5 / 2025.0),
              0.004);
}

// Adapted to one soak, a device is no more than the posterior says.
TEST(AdaptedSigma, CoversUnseenDevicesOfANormalPopulation) {
  const Population population = fit_population(
      kTemperatureInput, parabolas(200, 3, every_five_kelvins()), 5.0);
  const TrainingRows unseen = parabolas(133, 5, every_five_kelvins());
  double share = 0.0;
  for (int d = 0; d < 133; ++d) {
    const TrainingRows own = selected(unseen, unseen.device == d);
    const AdaptedBias adapted =
        adapted_bias(population, kTemperatureInput,
                     selected(own, own.temperature == 10.0), {});
    const BiasSigma sigma =
        adapted_sigma(population, adapted.deviation, PointNoise{}.bias);
    const ArrayXd error =
        own.bias -
        bias_curve(population, adapted.mean).predict(own.temperature);
    for (Index k = 0; k < own.size(); ++k)
      if (std::abs(error(k)) <=
          kNormalHalfWidth * sigma.at(own.temperature(k), 0.0, 0.0))
        share += 1.0 / (133.0 * static_cast<double>(own.size()));
  }
  // Rows of a device share their error: sqrt(0.09 / 133) = 0.026.
  EXPECT_NEAR(share, 0.9, 0.06);
}

// The posterior variance is linear in second moments: it is right on average
// for points that have their noise.
TEST(AdaptationSigma, IsOneForDevicesOfThePopulation) {
  const Population population = fit_population(
      kTemperatureInput, parabolas(200, 3, every_five_kelvins()), 5.0);
  TrainingRows unseen = parabolas(1000, 4, every_five_kelvins());
  const std::vector<double> z = white(static_cast<int>(unseen.size()) / 2, 77);
  for (Index k = 0; k < unseen.size(); ++k)  // two rows are a point
    unseen.bias(k) +=
        population.point_noise * z[static_cast<std::size_t>(k / 2)];
  const auto learned =
      adaptation_sigma(population, kTemperatureInput, unseen, {});
  ASSERT_TRUE(learned);
  EXPECT_EQ(learned->devices, 1000);
  EXPECT_NEAR(learned->factor, 1.0, 0.05);
  EXPECT_GT(learned->half_width, 0.9);
  EXPECT_LT(learned->half_width, 1.7);
  EXPECT_FALSE(learned->power_on);
  EXPECT_FALSE(learned->temperature_rate);
}

TEST(AdaptationSigma, TellsOfDevicesWhoseSoaksDetermineNoCurve) {
  const auto soaks = [](int device, double last) {
    TrainingRows rows = rows_of({{device, device, -40.0, -40.0, 2},
                                 {device, device, -10.0, -10.0, 2},
                                 {device, device, 20.0, 20.0, 2},
                                 {device, device, last, last, 2}},
                                [](double T, int) { return 0.01 * T; });
    rows.inputs = Eigen::ArrayXXd::Zero(rows.size(), 3);
    rows.inputs.col(0) = rows.temperature;
    return rows;
  };
  Names remarks;
  EXPECT_EQ(own_curve_residuals(soaks(0, 50.0), 5.0, remarks).size(), 8);
  EXPECT_EQ(remarks, Names{});
  EXPECT_EQ(own_curve_residuals(soaks(0, 20.0), 5.0, remarks).size(), 0);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].find("sigma on ramps and in warm-ups: 1 of 1 held-out "
                            "devices are left out, the last because cubic "
                            "spline: 3 knots"),
            0U)
      << remarks[0];
}

TEST(AdaptationSigma, IsWideWhereDevicesDifferMoreThanThePopulation) {
  const Population population = fit_population(
      kTemperatureInput, parabolas(200, 3, every_five_kelvins()), 5.0);
  TrainingRows others = parabolas(100, 4, every_five_kelvins());
  const ArrayXd wave = (others.temperature / 4.0).sin();
  others.bias += wave;  // unlike any device of the population
  const auto learned =
      adaptation_sigma(population, kTemperatureInput, others, {});
  ASSERT_TRUE(learned);
  EXPECT_GT(learned->factor, 3.0);
}

// Up and down; the bias is `hysteresis` times a normal number more on the way
// up.
TrainingRows both_ways(int devices, double hysteresis, double noise) {
  std::vector<Leg> legs;
  for (int d = 0; d < devices; ++d) {
    legs.push_back({d, d, -40.0, 50.0, 91});
    legs.push_back({d, d, 50.0, -40.0, 91});
  }
  const auto c = white(2 * devices, 21), offset = white(2 * devices, 22);
  return rows_of(legs, [&](double T, int row) {
    const auto d = static_cast<std::size_t>(row / 182);
    const auto leg = static_cast<std::size_t>(row / 91);
    return c[d] + 2e-4 * T * T + noise * offset[leg] +
           (leg % 2 == 0 ? hysteresis * c[d + c.size() / 2] : 0.0);
  });
}

// The turn-on offset of each way is taken off.
TEST(HysteresisRms, TellsUpFromDown) {
  const auto found = [](double a, double noise) {
    Population population =
        fit_population(kTemperatureInput, both_ways(400, a, noise), 5.0);
    population.point_noise = noise;
    return hysteresis_rms(population);
  };
  EXPECT_NEAR(found(0.3, 0.0), 0.3, 0.03);  // of 400 numbers: 3.5 %
  EXPECT_NEAR(found(0.3, 0.1), 0.3, 0.04);
  EXPECT_NEAR(found(0.0, 0.1), 0.0, 0.05);  // (0.02 7 %)^(1/2)
  EXPECT_EQ(
      hysteresis_rms(fit_population(
          kTemperatureInput, parabolas(20, 6, every_five_kelvins()), 5.0)),
      0.0);
}

TEST(AdaptedSigma, CountsTheOtherWayHalfOfTheTime) {
  Population population = fit_population(
      kTemperatureInput, parabolas(20, 6, every_five_kelvins()), 5.0);
  population.sigma.emplace().factor = 0.5;
  population.point_noise = 0.03;
  population.hysteresis = Eigen::MatrixXd::Constant(
      20, population.grid(), 0.5 * std::sqrt(0.2 * 0.2 + 2.0 * 0.03 * 0.03));
  const ArrayXd deviation = ArrayXd::Constant(population.grid(), 0.4);
  const BiasSigma sigma = adapted_sigma(population, deviation, 0.03);
  EXPECT_NEAR(sigma.at(10.0, 0.0, 0.0),
              std::sqrt(0.2 * 0.2 + 2.0 * 0.03 * 0.03 + 0.5 * 0.2 * 0.2),
              1e-12);
}

TEST(AdaptedSigma, AddsTheTurnOnOfTwoRunsOutsideTheFactor) {
  Population population = fit_population(
      kTemperatureInput, parabolas(20, 6, every_five_kelvins()), 5.0);
  population.sigma = AdaptationSigma{0.5, SigmaTerm{0.2, 300.0}, {}, 30, 1.5};
  const ArrayXd deviation = ArrayXd::Constant(population.grid(), 0.4);
  const BiasSigma sigma = adapted_sigma(population, deviation, 0.03);
  EXPECT_NEAR(sigma.at(10.0, 0.0, 0.0),
              std::sqrt(0.2 * 0.2 + 2.0 * 0.03 * 0.03), 1e-12);
  EXPECT_EQ(sigma.power_on, population.sigma->power_on);
  EXPECT_EQ(sigma.calibration.groups, 30U);
  EXPECT_EQ(sigma.calibration.half_width, 1.5);
  EXPECT_EQ(sigma.source, SigmaSource::kPosterior);
}

}  // namespace
}  // namespace beamgyro::internal::trained_sigma_test
