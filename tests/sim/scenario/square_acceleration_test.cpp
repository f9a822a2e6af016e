// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/scenario/filtered_motion.h"

namespace beamgyro::internal::square_acceleration_test {
namespace {

constexpr double kCorner = 2 * std::numbers::pi * 60;  // w_o [rad/s]

std::vector<double> shown(const Signal& along_y, double duration,
                          double rate = 1000) {
  const PiecewiseLinear still = PiecewiseLinear::constant(0);
  const std::array<Signal, 3> axes = {still, along_y, still};
  std::vector<double> samples(
      static_cast<std::size_t>(std::lround(duration * rate)));
  filtered_square_acceleration(axes, kCorner, rate)(samples);
  return samples;
}

TEST(SquareAcceleration, OfAConstantIsItsSquare) {
  for (const double v : shown(PiecewiseLinear::constant(-3), 0.5))
    EXPECT_NEAR(v, 9, 1e-13);
}

TEST(SquareAcceleration, OfAStepRisesAsTwoPolesDo) {
  const std::vector<double> v =
      shown(PiecewiseLinear({0, 0.0204, 0.0204}, {0, 0, 4}), 0.1);
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double x =
        std::max(0.0, kCorner * (1e-3 * static_cast<double>(k) - 0.0204));
    EXPECT_NEAR(v[k], 16 * (1 - (1 + x) * std::exp(-x)), 1e-12) << k;
  }
}

TEST(SquareAcceleration, OfARandomOneFollowsItsSquare) {
  const PiecewiseLinear a = realised({.rms = 3, .bandwidth = 0.1}, 100, 0, 0, 0,
                                     kAccelerationYStream);
  const std::vector<double> v = shown(a, 100, 10);
  for (std::size_t k = 1; k < v.size(); ++k) {
    const double t = static_cast<double>(k) / 10 - 2 / kCorner;  // the delay
    EXPECT_NEAR(v[k], a.value(t) * a.value(t), 2e-3) << t;
  }
}

// A long ramp a = b t: the filter's moments 2/w and 6/w^2 give
// b^2 (t^2 - 4 t/w + 6/w^2).
TEST(SquareAcceleration, OfARampLagsByTheMomentsOfTheFilter) {
  const std::vector<double> v = shown(PiecewiseLinear({0, 1}, {0, 50}), 1, 200);
  for (std::size_t k = 40; k < v.size(); ++k) {
    const double t = static_cast<double>(k) / 200;
    EXPECT_NEAR(v[k],
                2500 * (t * t - 4 * t / kCorner + 6 / (kCorner * kCorner)),
                1e-10);
  }
}

TEST(SquareAcceleration, DoesNotDependOnHowALineIsCutOrSampled) {
  const PiecewiseLinear whole({0.01, 0.09, 0.09, 0.3}, {5, -8, 2, 2});
  const PiecewiseLinear cut({0.01, 0.0101, 0.05, 0.09, 0.09, 0.1, 0.3},
                            {5, 5 - 13 / 800.0, -1.5, -8, 2, 2, 2});
  const std::vector<double> a = shown(whole, 0.3), b = shown(cut, 0.3);
  const std::vector<double> coarse = shown(whole, 0.3, 100);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(a[k], b[k], 1e-12) << k;
    if (k % 10 == 0) {
      EXPECT_NEAR(a[k], coarse[k / 10], 1e-12) << k;
    }
  }
}

// Two points a nanosecond apart are as good as a jump.
TEST(SquareAcceleration, StandsASteepPiece) {
  const std::vector<double> steep =
      shown(PiecewiseLinear({0, 0.05, 0.050000001}, {0, 0, 50}), 0.1);
  const std::vector<double> jump =
      shown(PiecewiseLinear({0, 0.05, 0.05}, {0, 0, 50}), 0.1);
  for (std::size_t k = 0; k < jump.size(); ++k)
    EXPECT_NEAR(steep[k], jump[k], 2e-3) << k;  // 1 ns x w_o x 2500
}

TEST(SquareAcceleration, OfASineIsThatOfItsPointsOnceSettled) {
  const double f = 37, w = 2 * std::numbers::pi * f;
  std::vector<double> time, value;
  for (int k = 0; k <= 100000; ++k) {
    time.push_back(1e-5 * k);
    value.push_back(1 + 5 * std::sin(w * time.back() + 0.7));
  }
  const std::vector<double> points = shown(PiecewiseLinear(time, value), 1);
  const std::vector<double> sine = shown(
      SineSignal{.offset = 1, .amplitude = 5, .frequency = f, .phase = 0.7}, 1);
  for (std::size_t k = 100; k < points.size(); ++k)
    EXPECT_NEAR(sine[k], points[k], 1e-4) << k;
}

}  // namespace
}  // namespace beamgyro::internal::square_acceleration_test
