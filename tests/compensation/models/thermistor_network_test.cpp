// SPDX-License-Identifier: MIT
#include "compensation/models/thermistor_network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::thermistor_network_test {
namespace {

using Eigen::ArrayXd;

double bend_of(const ThermistorNetwork& network) {
  return 1.0 /
         (1.0 / (network.series + network.divider) + 1.0 / network.parallel);
}

TEST(ThermistorNetwork, IsTheVoltageDividerOfItsDeclaration) {
  const ThermistorNetwork network{3950.0, 0.5, 4.0, 2.0, 0.1, 3.0};
  ArrayXd T(2);
  T << 25.0, 85.0;
  const ArrayXd b = network.predict(T);
  // At 25 degC the NTC is 1: p = 4 / 5.
  EXPECT_NEAR(b(0), 0.1 + 3.0 * 2.0 / (2.0 + 0.5 + 0.8), 1e-14);
  const double n = std::exp(3950.0 * (1.0 / 358.15 - 1.0 / 298.15));
  EXPECT_NEAR(b(1), 0.1 + 6.0 / (2.5 + 4.0 * n / (n + 4.0)), 1e-14);
}

TEST(ThermistorNetwork, ShapeDependsOnTheBendAlone) {
  const ArrayXd T = grid(-40.0, 85.0, 5.0);
  const ThermistorNetwork one{3950.0, 0.5, 4.0, 2.0, 0.0, 1.0};
  ThermistorNetwork other{3950.0, 3.0, 0.0, 7.0, 0.0, 1.0};
  other.parallel = 1.0 / (1.0 / bend_of(one) - 0.1);
  EXPECT_NEAR(bend_of(other), bend_of(one), 1e-14);
  const ArrayXd a = one.predict(T), b = other.predict(T);
  const double gain = (a(0) - a(25)) / (b(0) - b(25));
  EXPECT_LT((a - a(0) - gain * (b - b(0))).abs().maxCoeff(), 1e-14);
}

TEST(ThermistorNetwork, FitRecoversTheCurveOfAnyNetwork) {
  const ArrayXd T = grid(-40.0, 85.0, 2.5);
  for (const ThermistorNetwork& made :
       {ThermistorNetwork{3950.0, 0.5, 4.0, 2.0, 0.1, 3.0},
        ThermistorNetwork{3950.0, 0.01, 0.05, 0.02, -1.0, -20.0},
        ThermistorNetwork{3950.0, 30.0, 80.0, 40.0, 5.0, 200.0},
        ThermistorNetwork{3435.0, 1.0, 1.0, 1.0, 0.0, 5.0}}) {
    const ThermistorNetwork found =
        fit_thermistor_network(T, made.predict(T), made.b_K);
    EXPECT_LT((found.predict(T) - made.predict(T)).abs().maxCoeff(), 1e-9);
    EXPECT_NEAR(bend_of(found) / bend_of(made), 1.0, 1e-5);
    for (const double r : {found.series, found.parallel, found.divider}) {
      EXPECT_GE(r, kLeastBend);
      EXPECT_LE(r, 2.0 * kLargestBend);
    }
  }
}

// No other bend, with its own best offset and gain, leaves less.
TEST(ThermistorNetwork, FitOfAForeignCurveIsTheLeastOverAllBends) {
  const ArrayXd T = grid(-40.0, 50.0, 2.0), b = bias_curve(T);
  const auto squares = [&](const ThermistorNetwork& network) {
    return (network.predict(T) - b).square().sum();
  };
  const ThermistorNetwork best = fit_thermistor_network(T, b, 3950.0);
  for (double bend = kLeastBend; bend <= kLargestBend; bend *= 1.01) {
    ThermistorNetwork other{3950.0, bend, 2.0 * bend, bend, 0.0, 1.0};
    const ArrayXd share = other.predict(T) - other.predict(T).mean();
    other.gain = (share * (b - b.mean())).sum() / share.square().sum();
    other.offset += b.mean() - other.predict(T).mean();
    ASSERT_GE(squares(other), squares(best) * (1.0 - 1e-12)) << bend;
  }
  ThermistorNetwork off = best;
  off.gain *= 1.01;
  EXPECT_GT(squares(off), squares(best));
}

TEST(ThermistorNetwork, AConstantAsksForNoGain) {
  const ArrayXd T = grid(-40.0, 50.0, 5.0);
  const ThermistorNetwork found =
      fit_thermistor_network(T, ArrayXd::Constant(T.size(), 0.7), 3950.0);
  EXPECT_LT((found.predict(T) - 0.7).abs().maxCoeff(), 1e-12);
}

TEST(ThermistorNetwork, NeedsThreePointsOfSeveralTemperatures) {
  const ArrayXd two = grid(0.0, 5.0, 5.0);
  EXPECT_TRUE(
      holds(rejection([&] { fit_thermistor_network(two, two, 3950.0); }),
            "2 rows over 5 K"));
  const ArrayXd same = ArrayXd::Constant(9, 25.0);
  EXPECT_TRUE(
      holds(rejection([&] { fit_thermistor_network(same, same, 3950.0); }),
            "9 rows over 0 K"));
}

}  // namespace
}  // namespace beamgyro::internal::thermistor_network_test
