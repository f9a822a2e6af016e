// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "sim/memory/unit_memory.h"

namespace beamgyro::internal::play_operators_test {
namespace {

constexpr HysteresisParameters kNominal{.half_width = {0.5, 1.5, 4, 10},
                                        .weight = {0.2, 0.3, 0.3, 0.2},
                                        .stiffness = 4e-7,
                                        .loss = 5e-8,
                                        .mount_axis = 3.5e-4};

// The temperatures at which one of the operators begins to move or T turns, on
// a straight way: between them h is linear in T.
std::vector<double> way(double from, double to) {
  std::vector<double> points = {from, to};
  for (const double r : kNominal.half_width) {
    for (const double kink : {from + 2 * r, from - 2 * r, from + r, from - r})
      if (kink > std::min(from, to) && kink < std::max(from, to))
        points.push_back(kink);
  }
  std::ranges::sort(points);
  if (to < from) std::ranges::reverse(points);
  return points;
}

// int h dT along a way [K2], exactly by the trapezoidal rule.
double integral(PlayOperators& operators, double from, double to,
                double widest) {
  double sum = 0, T = from, h = operators.value();
  for (const double kink : way(from, to)) {
    const int parts = 1 + static_cast<int>(std::abs(kink - T) / widest);
    const double start = T;
    for (int i = 1; i <= parts; ++i) {
      const double next = std::lerp(start, kink, double(i) / parts);
      operators.push(next);
      sum += 0.5 * (h + operators.value()) * (next - T);
      T = next;
      h = operators.value();
    }
  }
  return sum;
}

double loop_area(double width, double widest) {
  const double low = 20, high = 20 + width;
  PlayOperators operators(kNominal, low);
  operators.push(high);
  operators.push(low);  // on the closed loop from here
  return -(integral(operators, low, high, widest) +
           integral(operators, high, low, widest));
}

double closed_form(double width) {
  double area = 0;
  for (std::size_t i = 0; i < kPlayOperators; ++i) {
    const double r = kNominal.half_width[i];
    area += kNominal.weight[i] * 2 * r * std::max(0.0, width - 2 * r);
  }
  return area;
}

// Relative to the area; the sums have some 1e3 terms.
TEST(V52PlayOperators, EncloseTheAreaOfTheClosedForm) {
  for (const double width : {5.0, 20.0, 90.0}) {
    const double area = closed_form(width);
    // A sample a second at 0.1 and at 10 K/min.
    for (const double step : {0.1 / 60, 10.0 / 60})
      EXPECT_NEAR(loop_area(width, step), area, 1e-12 * area) << width;
  }
}

TEST(V52PlayOperators, AreAtTheirExtremesAfterALongRiseAndALongFall) {
  PlayOperators operators(kNominal, 25);
  operators.push(60);
  EXPECT_NEAR(operators.share(), -1, 1e-12);
  operators.push(0);
  EXPECT_NEAR(operators.share(), 1, 1e-12);
  EXPECT_NEAR(operators.largest(), 3.75, 1e-12);
}

double at_the_end(std::initializer_list<double> turns) {
  PlayOperators operators(kNominal, 0);
  for (const double T : turns) operators.push(T);
  return operators.value();
}

TEST(V53PlayOperators, RememberTheirReturnPoint) {
  const double before = at_the_end({-60, 60, 20, 45});
  EXPECT_NEAR(at_the_end({-60, 60, 20, 45, 30, 40, 33, 45}), before, 1e-12);
  // A wider loop wipes the smaller one out.
  EXPECT_NEAR(at_the_end({-60, 60, 20, 45, 30, 62}),
              at_the_end({-60, 60, 20, 62}), 1e-12);
}

TEST(V53PlayOperators, HaveCongruentMinorLoops) {
  // The same excursion 20 -> 32 -> 20 from different histories.
  PlayOperators fallen(kNominal, 90), risen(kNominal, -90);
  fallen.push(20);
  risen.push(55);
  risen.push(20);
  for (PlayOperators* operators : {&fallen, &risen}) {
    operators->push(32);
    operators->push(20);
  }
  const double offset = fallen.value() - risen.value();
  for (int i = 0; i <= 24; ++i) {
    const double T = i <= 12 ? 20 + i : 44 - i;
    fallen.push(T);
    risen.push(T);
    EXPECT_NEAR(fallen.value() - risen.value(), offset, 1e-12) << T;
  }
}

TEST(PlayOperators, GiveTheValueAtAnyPointOfAMonotoneMove) {
  PlayOperators moved(kNominal, 30);
  moved.push(10);
  const PlayOperators turned = moved;
  for (const double T : {10.0, 10.3, 12.0, 17.5, 40.0}) {
    moved.push(T);
    EXPECT_EQ(turned.share(turned.states(), T), moved.share());
  }
}

}  // namespace
}  // namespace beamgyro::internal::play_operators_test
