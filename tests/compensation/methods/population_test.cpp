// SPDX-License-Identifier: MIT
#include "compensation/methods/population.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::population_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const std::vector<Input> kTemperature = {parse_input("temperature")};
const std::vector<Input> kWithQuadrature = {parse_input("temperature"),
                                            parse_input("quadrature")};

// Parabolas of bias and quadrature: splines hold them exactly.
struct DeviceParameters {
  double a, b, c;

  double bias(double T) const { return a + b * T + c * T * T; }
  double quadrature(double T) const { return 30.0 * c * 1e3 + 0.5 * T; }
};

const std::vector<DeviceParameters> kDevices = {{1.0, 0.03, 1e-3},
                                                {-2.0, 0.01, -2e-3},
                                                {0.5, -0.05, 5e-4},
                                                {3.0, 0.02, 2e-3},
                                                {-1.0, 0.04, -1e-3}};

// Rows of devices at given temperatures.
TrainingRows rows_at(const std::vector<DeviceParameters>& devices,
                     const std::vector<double>& temperatures) {
  std::vector<Leg> legs;
  for (std::size_t d = 0; d < devices.size(); ++d)
    for (const double T : temperatures)
      legs.push_back({static_cast<int>(d), static_cast<int>(d), T, T, 1});
  const auto count = static_cast<int>(temperatures.size());
  TrainingRows rows = rows_of(legs, [&](double T, int k) {
    return devices[static_cast<std::size_t>(k / count)].bias(T);
  });
  rows.inputs.conservativeResize(Eigen::NoChange, 2);
  for (Index k = 0; k < rows.size(); ++k)
    rows.inputs(k, 1) =
        devices[static_cast<std::size_t>(rows.device(k))].quadrature(
            rows.temperature(k));
  return rows;
}

TrainingRows with_temperature_only(TrainingRows rows) {
  rows.inputs = rows.inputs.leftCols(1).eval();
  return rows;
}

Population of_parabolas() {
  return fit_population(kWithQuadrature,
                        rows_at(kDevices, every_five_kelvins()), 5.0);
}

// mu = 1 + T / 10, one mode: bias 2 c, quadrature 10 c.
Population one_mode(bool quadrature) {
  Population p;
  p.temperatures = ArrayXd::LinSpaced(10, -40.0, 50.0);
  if (quadrature) p.channels = {parse_input("quadrature")};
  const Index curves = quadrature ? 2 : 1;
  p.mean = VectorXd::Zero(10 * curves);
  p.mean.head(10) = 1.0 + 0.1 * p.temperatures;
  p.modes = MatrixXd::Constant(10 * curves, 1, 10.0);
  p.modes.topRows(10).setConstant(2.0);
  p.devices = 100;
  return p;
}

TEST(Population, KnowsHowLongItsSweepsTook) {
  // A row a minute, 5 K apart, a run of each device.
  const Population once = of_parabolas();
  ASSERT_TRUE(once.sweeps.has_value());
  EXPECT_NEAR(once.sweeps->seconds_per_K, 12.0, 1e-9);
  EXPECT_NEAR(once.sweeps->of_each_device, 1.0, 1e-12);
  // Runs of half of the temperatures are no sweeps.
  TrainingRows rows = rows_at(kDevices, every_five_kelvins());
  for (Index k = 0; k < rows.size(); ++k)
    rows.run(k) = 2 * rows.device(k) + (rows.temperature(k) > 0.0 ? 1 : 0);
  EXPECT_FALSE(fit_population(kWithQuadrature, rows, 5.0).sweeps.has_value());
}

TEST(Population, TrueHysteresisIsWithoutTheNoiseOfTwoPoints) {
  Population p = one_mode(false);
  p.hysteresis = MatrixXd::Constant(100, 10, 0.05);
  p.hysteresis.col(0).setConstant(-0.05);
  // 0.1 deg/s between the ways, less 0.03 deg/s of each.
  EXPECT_NEAR(hysteresis_rms(p), std::sqrt(0.01 - 2 * 9e-4), 1e-12);
  const MatrixXd half = true_hysteresis(p);
  EXPECT_NEAR(half(7, 0), -0.5 * hysteresis_rms(p), 1e-12);
  EXPECT_NEAR(half(99, 9), 0.5 * hysteresis_rms(p), 1e-12);
  p.hysteresis.setConstant(0.01);
  EXPECT_EQ(true_hysteresis(p).cwiseAbs().maxCoeff(), 0.0);
  p.hysteresis.resize(0, 0);
  EXPECT_EQ(true_hysteresis(p).size(), 0);
}

TEST(Population, MeanAndCovarianceAreThoseOfTheCurves) {
  const Population p = of_parabolas();
  EXPECT_EQ(p.devices, 5);
  ASSERT_EQ(p.grid(), 19);
  EXPECT_EQ(p.range(), (TemperatureRange{-40.0, 50.0}));
  MatrixXd curves(2 * p.grid(), 5);
  for (Index d = 0; d < 5; ++d)
    for (Index k = 0; k < p.grid(); ++k) {
      const DeviceParameters& device = kDevices[static_cast<std::size_t>(d)];
      curves(k, d) = device.bias(p.temperatures(k));
      curves(p.grid() + k, d) = device.quadrature(p.temperatures(k));
    }
  const VectorXd mean = curves.rowwise().mean();
  const MatrixXd X = curves.colwise() - mean;
  EXPECT_LT((p.mean - mean).cwiseAbs().maxCoeff(), 1e-9);
  const MatrixXd covariance = X * X.transpose() / 4.0;
  EXPECT_LT((p.modes * p.modes.transpose() - covariance).cwiseAbs().maxCoeff(),
            1e-9 * covariance.cwiseAbs().maxCoeff());
  // Parabolas have three numbers, and the quadrature repeats one of them.
  EXPECT_EQ(p.modes.cols(), 3);
}

TEST(Population, OnePointPullsTheMeanAsBayesSays) {
  const Population p = one_mode(false);
  TrainingRows rows =
      rows_of({{0, 0, 17.0, 17.0, 1}}, [](double, int) { return 2.7 + 1.5; });
  for (const double s : {0.1, 1.0, 3.0}) {  // [deg/s]
    const AdaptedBias b = adapted_bias(p, kTemperature, rows, {s, 0.01});
    // Prior variance 4, of the row s^2.
    const double pull = 1.5 * 4.0 / (4.0 + s * s);
    EXPECT_LT((b.mean - (1.0 + 0.1 * p.temperatures + pull)).abs().maxCoeff(),
              1e-12);
    EXPECT_LT(
        (b.deviation - std::sqrt(4.0 * s * s / (4.0 + s * s))).abs().maxCoeff(),
        1e-12);
  }
}

TEST(Population, RowsOfASoakAreOnePoint) {
  const Population p = one_mode(false);
  const PointNoise noise{0.5, 0.01};
  const AdaptedBias many =
      adapted_bias(p, kTemperature,
                   rows_of({{0, 0, 16.5, 17.5, 101}, {0, 0, 40.0, 40.0, 1}},
                           [](double T, int) { return 2.5 + 0.1 * T; }),
                   noise);
  const AdaptedBias two =
      adapted_bias(p, kTemperature,
                   rows_of({{0, 0, 40.0, 40.0, 1}, {0, 0, 17.0, 17.0, 1}},
                           [](double T, int) { return 2.5 + 0.1 * T; }),
                   noise);
  EXPECT_LT((many.mean - two.mean).abs().maxCoeff(), 1e-12);
  EXPECT_LT((many.deviation - two.deviation).abs().maxCoeff(), 1e-12);
}

TEST(Population, RowsBeyondItsTemperaturesTellNothing) {
  const Population p = one_mode(false);
  TrainingRows rows =
      rows_of({{0, 0, 17.0, 17.0, 1}, {0, 0, 50.0, 50.0, 1}},
              [](double T, int) { return T > 20.0 ? 9.0 : 4.2; });
  const PointNoise noise{0.5, 0.01};
  const TrainingRows inside = selected(rows, rows.temperature < 20.0);
  const AdaptedBias expected = adapted_bias(p, kTemperature, inside, noise);
  rows.beyond_range(1) = 3.0;  // [K], it was measured at 53 degC
  EXPECT_TRUE(
      (adapted_bias(p, kTemperature, rows, noise).mean == expected.mean).all());
  rows.beyond_range(1) = 0.1;  // a rounding
  EXPECT_GT((adapted_bias(p, kTemperature, rows, noise).mean - expected.mean)
                .abs()
                .minCoeff(),
            0.1);
}

TEST(Population, AChannelTellsOfTheBias) {
  const Population p = one_mode(true);
  TrainingRows rows =
      rows_of({{0, 0, 17.0, 17.0, 1}}, [](double, int) { return 2.7 + 1.5; });
  rows.inputs.conservativeResize(1, 2);
  rows.inputs(0, 1) = 4.0;  // 0.4 of a deviation
  const PointNoise noise{1.0, 0.5};
  const AdaptedBias b = adapted_bias(p, kWithQuadrature, rows, noise);
  // c of precision 1 + (2 / 1)^2 + (10 / 5)^2.
  const double c = (2.0 * 1.5 + 10.0 * 4.0 / 25.0) / 9.0;
  EXPECT_NEAR(b.mean(0), -3.0 + 2.0 * c, 1e-12);
  EXPECT_NEAR(b.deviation(0), 2.0 / 3.0, 1e-12);
}

TEST(Population, ThreeExactPointsAreMetAndTellTheParabola) {
  const Population p = of_parabolas();
  const DeviceParameters unseen{-0.7, 0.06, 1.4e-3};
  const TrainingRows soaks = rows_at({unseen}, {-33.0, -5.0, 45.0});
  for (const auto& inputs : {kTemperature, kWithQuadrature}) {
    const AdaptedBias b = adapted_bias(
        p, inputs, inputs.size() == 1 ? with_temperature_only(soaks) : soaks,
        {1e-7, 1e-7});
    const CubicSpline curve = bias_curve(p, b.mean);
    for (double T = -40.0; T <= 50.0; T += 2.5)
      EXPECT_NEAR(curve.predict(ArrayXd::Constant(1, T))(0), unseen.bias(T),
                  1e-5)
          << T;
  }
}

TEST(Population, NoisyRowsLeaveTheMean) {
  const Population p = of_parabolas();
  const TrainingRows soaks = rows_at({{9.0, 0.0, 0.0}}, {-33.0, 45.0});
  const AdaptedBias b = adapted_bias(p, kWithQuadrature, soaks, {1e9, 1e9});
  EXPECT_LT((b.mean - p.mean.head(p.grid()).array()).abs().maxCoeff(), 1e-9);
  const MatrixXd modes = p.modes.topRows(p.grid());
  EXPECT_LT((b.deviation - modes.rowwise().norm().array()).abs().maxCoeff(),
            1e-9);
}

TEST(Population, GridCoversWhatAllDevicesHave) {
  TrainingRows rows = rows_at(kDevices, every_five_kelvins());
  for (Index k = 0; k < rows.size(); ++k) rows.temperature(k) += rows.device(k);
  const Population p = fit_population(kWithQuadrature, rows, 5.0);
  EXPECT_EQ(p.range(), (TemperatureRange{-36.0, 50.0}));
  EXPECT_EQ(p.grid(), 19);  // steps of 86 / 18 K
}

TEST(Population, EqualDevicesLeaveNothingOpen) {
  const Population p = fit_population(
      kWithQuadrature, rows_at({{1, 0, 0}, {1, 0, 0}}, every_five_kelvins()),
      5.0);
  const AdaptedBias b =
      adapted_bias(p, kWithQuadrature, rows_at({{3, 0, 0}}, {20.0}), {});
  EXPECT_LT((b.mean - 1.0).abs().maxCoeff(), 1e-9);
  EXPECT_LT(b.deviation.maxCoeff(), 1e-6);
}

TEST(Population, RefusesWhatTellsNothingOfDevices) {
  const auto message = [](const TrainingRows& rows) {
    return rejection([&] { fit_population(kWithQuadrature, rows, 5.0); });
  };
  EXPECT_TRUE(holds(message(rows_at({kDevices[0]}, every_five_kelvins())),
                    "two devices or more"));
  EXPECT_TRUE(holds(message(rows_at(kDevices, {20.0, 24.0, 28.0})),
                    "share the temperatures 20.00 to 28.00 degC"));
  EXPECT_TRUE(holds(message(rows_at(kDevices, {-40.0, 0.0, 50.0})),
                    "device 1 of 5: cubic spline: 3 knots"));
  EXPECT_TRUE(holds(rejection([] {
                      adapted_bias(one_mode(false), kWithQuadrature,
                                   rows_at({kDevices[0]}, {20.0}), {});
                    }),
                    "does not know the input \"quadrature\""));
}

}  // namespace
}  // namespace beamgyro::internal::population_test
