// SPDX-License-Identifier: MIT
#include "compensation/methods/resonances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "compensation/methods/bias_model.h"
#include "compensation/methods/bump_shares.h"
#include "compensation/methods/lines_and_bumps.h"
#include "compensation/methods/quadrature_fit.h"
#include "tests/compensation/bias_curve.h"
#include "tests/compensation/rows_of.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::resonances_test {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A resonance of the closed forms (13.4) and (13.5).
struct Resonance {
  double place, width;  // width < 0: it crosses the other way
  double height;

  double u(double T) const { return 2.0 * (T - place) / width; }
  double bias(double T) const { return height / (1.0 + u(T) * u(T)); }
  double quadrature(double T) const { return -u(T) * bias(T); }
};

double bias_at(const std::vector<Resonance>& all, double T) {
  double sum = 0.02 + 1e-4 * T;
  for (const Resonance& one : all) sum += one.bias(T);
  return sum;
}

double quadrature_at(const std::vector<Resonance>& all, double T) {
  double sum = 0.1 - 3e-4 * T + 2e-6 * T * T;
  for (const Resonance& one : all) sum += one.quadrature(T);
  return sum;
}

const std::vector<Resonance> kTwo = {{-12.0, 6.0, 0.04}, {21.0, -9.0, 0.05}};

// Soaks every 15 K from -40 to 50 degC, two rows each, and a row of quadrature
// every kelvin between. The sensor is `ahead` [K] in the rows of the ramps.
TrainingRows soaks_and_ramps(const std::vector<Resonance>& all,
                             double ahead = 0.0) {
  std::vector<Leg> legs;
  for (int k = 0; k < 7; ++k)
    legs.push_back({0, 0, -40.0 + 15.0 * k, -40.0 + 15.0 * k, 2});
  TrainingRows rows =
      rows_of(legs, [&](double T, int) { return bias_at(all, T); });
  const auto columns = [&](const ArrayXd& T, double lead) {
    ArrayXXd x(T.size(), 3);
    x.col(0) = T + lead;
    x.col(1) = T - lead;  // a low-pass that is as far behind
    x.col(2) = T.unaryExpr([&](double at) { return quadrature_at(all, at); });
    return x;
  };
  rows.inputs = columns(rows.temperature, 0.0);
  rows.moving = columns(grid(-40.0, 50.0, 1.0), ahead);
  return rows;
}

// The same soaks, and ramps whose bias is known, too.
TrainingRows with_bias_of_ramps(const std::vector<Resonance>& all,
                                double ahead) {
  const TrainingRows soaks = soaks_and_ramps(all, ahead);
  TrainingRows rows =
      rows_of({{0, 0, -40.0, 50.0, 14}, {0, 0, -40.0, 50.0, 91}},
              [&](double T, int) { return bias_at(all, T); });
  rows.bias.head(14) = soaks.bias;
  rows.inputs.resize(105, 3);
  rows.inputs << soaks.inputs, soaks.moving;
  return rows;
}

const std::vector<Input>& inputs() {
  static const std::vector<Input> all = {
      parse_input("temperature"), parse_input("temperature_lowpass(400)"),
      parse_input("quadrature")};
  return all;
}

Fit fit_of(const TrainingRows& rows, const ResonancesSpec& spec = {}) {
  return fit_model(spec, inputs(), rows, {}, 1);
}

const ResonanceCurve& curve_of(const Fit& fit) {
  return std::get<ResonanceCurve>(fit.model.function);
}

// Errors of the bias over -40 ... 50 degC; the sensor is `ahead` [K] and the
// low-pass knows nothing of it.
ArrayXd errors_of(const Fit& fit, const std::vector<Resonance>& all,
                  double ahead) {
  const ArrayXd T = grid(-39.0, 49.0, 0.5);
  ArrayXXd x(T.size(), 3);
  x.col(0) = x.col(1) = T + ahead;
  ArrayXd truth(T.size());
  for (Index k = 0; k < T.size(); ++k) {
    x(k, 2) = quadrature_at(all, T(k));
    truth(k) = bias_at(all, T(k));
  }
  return fit.model.predict(x) - truth;
}

double worst_error(const Fit& fit, const std::vector<Resonance>& all) {
  return errors_of(fit, all, 0.0).abs().maxCoeff();
}

double rms_error(const Fit& fit, const std::vector<Resonance>& all,
                 double ahead) {
  return std::sqrt(errors_of(fit, all, ahead).square().mean());
}

double worst_of_straight_lines(const std::vector<Resonance>& all) {
  TrainingRows rows = soaks_and_ramps(all);
  rows.inputs = rows.inputs.leftCols(1).eval();
  const Fit lines = fit_model(TableSpec{5.0, true},
                              {parse_input("temperature")}, rows, {}, 1);
  const ArrayXd T = grid(-39.0, 49.0, 0.5);
  return (lines.model.predict(T) -
          T.unaryExpr([&](double at) { return bias_at(all, at); }))
      .abs()
      .maxCoeff();
}

// Without noise the fit ends where rounding does.
TEST(QuadratureFit, FindsPairsOfTheClosedFormExactly) {
  const VectorXd T = VectorXd::LinSpaced(181, -1.0, 1.0);
  const Resonance first{-0.3, 0.15, 0.4}, second{0.45, 0.3, -0.2};
  const VectorXd q = T.unaryExpr([&](double t) {
    return 0.2 - 0.1 * t + 0.3 * t * t * t + first.quadrature(t) +
           second.quadrature(t);
  });
  const QuadratureFit fit = fit_quadrature(T, MatrixXd(T.size(), 0), q);
  ASSERT_EQ(fit.places.size(), 2);
  const Index left = fit.places(0) < fit.places(1) ? 0 : 1;
  EXPECT_NEAR(fit.places(left), -0.3, 1e-6);
  EXPECT_NEAR(fit.widths(left), 0.15, 1e-6);
  EXPECT_NEAR(fit.heights(left), 0.4, 1e-6);
  EXPECT_NEAR(fit.places(1 - left), 0.45, 1e-6);
  EXPECT_NEAR(fit.widths(1 - left), 0.3, 1e-6);
  EXPECT_NEAR(fit.heights(1 - left), -0.2, 1e-6);
  EXPECT_NEAR(fit.smooth(0), 0.2, 1e-6);
  EXPECT_NEAR(fit.smooth(3), 0.3, 1e-6);
}

// One in a hundred draws of noise alone may pass for a resonance.
TEST(QuadratureFit, EvidenceDecidesHowManyThereAre) {
  const VectorXd T = VectorXd::LinSpaced(181, -1.0, 1.0);
  const std::vector<Resonance> all = {
      {-0.6, 0.2, 0.1}, {0.1, 0.15, -0.1}, {0.7, 0.3, 0.1}};
  for (std::size_t count = 0; count <= all.size(); ++count) {
    const std::vector<double> noise =
        white(181, static_cast<std::uint32_t>(count));
    VectorXd q(T.size());
    for (Index k = 0; k < T.size(); ++k) {
      q(k) = 0.3 * T(k) + 2e-3 * noise[static_cast<std::size_t>(k)];
      for (std::size_t n = 0; n < count; ++n) q(k) += all[n].quadrature(T(k));
    }
    const QuadratureFit fit = fit_quadrature(T, MatrixXd(T.size(), 0), q);
    EXPECT_EQ(fit.places.size(), static_cast<Index>(count));
    EXPECT_NEAR(fit.rms, 2e-3, 4e-4);
  }
}

TEST(QuadratureFit, NoMoreThanAllowedAndTheSameEachTime) {
  const VectorXd T = VectorXd::LinSpaced(2000, -1.0, 1.0);
  const VectorXd q = T.unaryExpr([](double t) { return std::sin(20.0 * t); });
  const MatrixXd none(T.size(), 0);
  const QuadratureFit fit = fit_quadrature(T, none, q, {3, 2, 0.03, 1.2});
  EXPECT_EQ(fit.places.size(), 2);
  const QuadratureFit again = fit_quadrature(T, none, q, {3, 2, 0.03, 1.2});
  EXPECT_EQ(fit.places, again.places);
  EXPECT_EQ(fit.heights, again.heights);
}

TEST(BumpShares, TellHillsFromDipsAndFromNothing) {
  const VectorXd t = VectorXd::LinSpaced(7, -1.0, 1.0);
  MatrixXd bumps(7, 3);
  for (Index k = 0; k < 7; ++k)
    bumps.row(k) << Resonance{-0.6, 0.4, 0.1}.bias(t(k)),
        Resonance{0.05, 0.3, 0.1}.bias(t(k)),
        Resonance{0.7, 0.5, 0.1}.bias(t(k));
  const VectorXd bias =
      (0.3 + 0.01 * t.array()).matrix() + bumps.col(0) - bumps.col(1);
  const VectorXd shares = bump_shares(t, bias, bumps, 1e-4);
  EXPECT_NEAR(shares(0), 1.0, 0.05);
  EXPECT_NEAR(shares(1), -1.0, 0.05);
  EXPECT_NEAR(shares(2), 0.0, 0.05);
  EXPECT_EQ(bump_shares(t, VectorXd::Ones(7), bumps, 1e-4), VectorXd::Zero(3));
}

TEST(LinesAndBumps, AreFoundTogether) {
  const ArrayXd t = grid(-1.0, 1.0, 0.02);
  MatrixXd bumps(t.size(), 2);
  bumps.col(0) = t.unaryExpr([](double at) {
    return Resonance{-0.3, 0.2, 0.1}.bias(at);
  });
  bumps.col(1) = t.unaryExpr([](double at) {
    return Resonance{0.5, 0.3, 0.1}.bias(at);
  });
  const ArrayXd bias = 0.3 - 0.2 * t - 0.7 * bumps.col(0).array();
  const LinesAndBumps fit = fit_lines_and_bumps(t, bias, bumps, 0.25);
  ASSERT_EQ(fit.lines.values.size(), 9);
  EXPECT_NEAR(fit.shares(0), -0.7, 1e-4);
  EXPECT_NEAR(fit.shares(1), 0.0, 1e-4);
  EXPECT_LT((fit.lines.values - (0.3 - 0.2 * fit.lines.temperatures))
                .abs()
                .maxCoeff(),
            1e-5);
  EXPECT_LT(fit.rms, 1e-5);
}

// Rows at two ends tell the line between them.
TEST(LinesAndBumps, AKnotWithoutRowsLiesBetweenTheOthers) {
  ArrayXd t(8);
  t << -1.0, -0.9, -0.8, -0.7, 0.7, 0.8, 0.9, 1.0;
  const LinesAndBumps fit =
      fit_lines_and_bumps(t, 2.0 + 3.0 * t, MatrixXd(8, 0), 0.1);
  EXPECT_NEAR(fit.lines.at(0.0), 2.0, 1e-3);
  EXPECT_NEAR(fit.lines.at(0.33), 2.99, 1e-3);
}

TEST(LinesAndBumps, OfOneValueOrOnePlaceAndOfNone) {
  const LinesAndBumps same =
      fit_lines_and_bumps(ArrayXd::LinSpaced(5, 0.0, 1.0),
                          ArrayXd::Constant(5, 7.0), MatrixXd::Ones(5, 1), 0.5);
  EXPECT_EQ(same.lines.at(0.4), 7.0);
  EXPECT_EQ(same.shares, VectorXd::Zero(1));
  const LinesAndBumps one = fit_lines_and_bumps(
      ArrayXd::Ones(2), ArrayXd::LinSpaced(2, 1.0, 3.0), MatrixXd(2, 0), 0.5);
  EXPECT_NEAR(one.lines.at(1.0), 2.0, 1e-9);
  EXPECT_THROW(fit_lines_and_bumps(ArrayXd(0), ArrayXd(0), MatrixXd(0, 0), 0.5),
               std::invalid_argument);
  EXPECT_THROW(fit_lines_and_bumps(ArrayXd::Ones(2), ArrayXd::Ones(2),
                                   MatrixXd(2, 0), 0.0),
               std::invalid_argument);
}

TEST(Resonances, SoaksAndQuadratureBetweenThemTellTheBiasBetween) {
  const Fit fit = fit_of(soaks_and_ramps(kTwo));
  ASSERT_EQ(curve_of(fit).places.size(), 2);
  const double lines = worst_of_straight_lines(kTwo);
  EXPECT_GT(lines, 0.015);
  EXPECT_LT(worst_error(fit, kTwo), 0.1 * lines);
  ASSERT_EQ(fit.choices.size(), 3);
  EXPECT_TRUE(holds(fit.choices[0], "2 resonances, 91 rows of quadrature"));
}

// With the other sign of height and slope quadrature is the same.
TEST(Resonances, BothSignsAreTried) {
  std::vector<Resonance> turned = kTwo;
  for (Resonance& one : turned) {
    one.height = -one.height;
    one.width = -one.width;
  }
  for (const double T : {-30.0, -10.0, 25.0})
    ASSERT_EQ(quadrature_at(turned, T), quadrature_at(kTwo, T));
  const Fit fit = fit_of(soaks_and_ramps(turned));
  EXPECT_LT(worst_error(fit, turned), 0.1 * worst_of_straight_lines(turned));
}

TEST(Resonances, WithoutAnyTheyAreStraightLinesBetweenSoaks) {
  const Fit fit = fit_of(soaks_and_ramps({}));
  EXPECT_EQ(curve_of(fit).places.size(), 0);
  // What the damping of the fit, 1e-10, leaves of the quadrature shifts a line.
  EXPECT_LT(worst_error(fit, {}), 1e-8);
}

// The sensor is 2 K ahead of the beam and its low-pass 2 K behind: half of
// each.
TEST(Resonances, LearnHowFarTheBeamIsBehindTheSensor) {
  const Fit fit = fit_of(soaks_and_ramps(kTwo, 2.0));
  EXPECT_NEAR(curve_of(fit).position(0), 0.5, 0.01);
  EXPECT_NEAR(curve_of(fit).position(1), 0.5, 0.01);
  EXPECT_LT(worst_error(fit, kTwo), 0.1 * worst_of_straight_lines(kTwo));
}

// Near the tops of the quadrature two places suit it, so the worst is no less.
TEST(Resonances, QuadratureIsAThermometerOfTheBeam) {
  ResonancesSpec spec;
  spec.quadrature_noise = 1e-4;
  spec.beam_sigma_K = 1.0;
  const Fit with = fit_of(soaks_and_ramps(kTwo), spec);
  spec.quadrature_noise = 1e6;  // worth nothing
  const Fit without = fit_of(soaks_and_ramps(kTwo), spec);
  EXPECT_LT(rms_error(with, kTwo, 0.7), 0.5 * rms_error(without, kTwo, 0.7));
}

TEST(Resonances, TakeTheBiasOfRampsAtTheTemperatureOfTheBeam) {
  ResonancesSpec spec;
  spec.quadrature_noise = 1e6;  // not corrected at run time
  spec.knot_spacing_K = 5.0;
  const Fit fit = fit_of(with_bias_of_ramps(kTwo, 2.0), spec);
  EXPECT_NEAR(curve_of(fit).position(0), 0.5, 0.01);
  EXPECT_LT(worst_error(fit, kTwo), 0.02 * worst_of_straight_lines(kTwo));
}

// A resonance of the case shows in the quadrature alone.
TEST(Resonances, TheBiasOfRampsTellsThatABumpHasNone) {
  TrainingRows rows = with_bias_of_ramps(kTwo, 0.0);
  rows.bias = 0.02 + 1e-4 * rows.inputs.col(0);
  ResonancesSpec spec;
  spec.knot_spacing_K = 5.0;
  const Fit fit = fit_of(rows, spec);
  ASSERT_EQ(curve_of(fit).places.size(), 2);
  EXPECT_LT(curve_of(fit).bias_heights.cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Resonances, ARampIsNoSoak) {
  TrainingRows rows = rows_of({{0, 0, -40.0, 50.0, 90}},
                              [](double T, int) { return 0.01 * T; });
  rows.inputs = ArrayXXd(90, 3);
  rows.inputs.col(0) = rows.inputs.col(1) = rows.temperature;
  rows.inputs.col(2) = rows.temperature;
  EXPECT_TRUE(holds(rejection([&] { fit_of(rows); }), "rows.steady_K_per_min"));
}

}  // namespace
}  // namespace beamgyro::internal::resonances_test
