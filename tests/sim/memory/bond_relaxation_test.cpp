// SPDX-License-Identifier: MIT
#include "sim/memory/bond_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace beamgyro::internal::bond_relaxation_test {
namespace {

constexpr double kZero = 273.15, kGlass = 311.15;  // [K]
constexpr RelaxationParameters kNominal{.activation = 6e5,
                                        .nonlinearity = 0.4,
                                        .modulus_per_K = 2e-3,
                                        .initial_offset = {}};

// T_f [degC] after cooling from 70 to 5 degC at a rate [K/min].
double cooled(double rate) {
  BondRelaxation bond(kNominal, kGlass, kZero + 70);
  bond.advance(kZero + 70, kZero + 5, 65 / rate * 60);
  return bond.fictive_temperature() - kZero;
}

// The tolerances are those of the specification; its values are printed to
// 1e-3 K.
TEST(V49BondRelaxation, EndsAtTheFictiveTemperatureOfItsCoolingRate) {
  EXPECT_NEAR(cooled(0.2), 32.132, 0.01);
  EXPECT_NEAR(cooled(1), 34.206, 0.01);
  EXPECT_NEAR(cooled(5), 36.308, 0.01);
  EXPECT_NEAR(cooled(20), 38.143, 0.01);
}

TEST(V50BondRelaxation, SmallIsothermalStepFollowsAnExponentialInEachMode) {
  // A step of 1e-6 K changes tau_s by less than 1e-6 of itself.
  const double T = kGlass + 5, step = 1e-6;
  BondRelaxation bond(kNominal, kGlass, T);
  const double tau = bond.time_constant(T + step);
  const double time = 0.7 * tau;
  bond.advance(T + step, T + step, time);
  for (std::size_t j = 0; j < BondRelaxation::kModes; ++j) {
    const double left = std::exp(-time / (BondRelaxation::kTimes[j] * tau));
    // Roundoff of a difference of 1e-6 K at 316 K is 6e-8 of it.
    EXPECT_NEAR((T + step - bond.modes()[j]) / step, left, 1e-6) << j;
  }
}

TEST(V51BondRelaxation, FictiveTemperatureRisesWithTheLogarithmOfTheRate) {
  const double slope = (cooled(20) - cooled(0.2)) / std::log(20 / 0.2);
  EXPECT_NEAR(slope, 1.305, 0.005);
}

TEST(BondRelaxation, StepsOfAKelvinAreThoseOfAHundredth) {
  for (const double rate : {0.05, 1.0, 20.0}) {  // [K/min]
    BondRelaxation coarse(kNominal, kGlass, kZero + 70), fine = coarse;
    double T = kZero + 70;
    for (int i = 0; i < 330; ++i) {
      const double step = i < 110 || i >= 220 ? -1 : 1;
      coarse.advance(T, T + step, 60 / rate);
      for (int k = 0; k < 100; ++k, T += step / 100)
        fine.advance(T, T + step / 100, 0.6 / rate);
      ASSERT_NEAR(coarse.fictive_temperature(), fine.fictive_temperature(),
                  4e-4)
          << rate << " K/min, " << T - kZero;
    }
  }
}

TEST(BondRelaxation, IsAtTheGlassTimeAtTheGlassTransition) {
  EXPECT_DOUBLE_EQ(
      BondRelaxation(kNominal, kGlass, kGlass).time_constant(kGlass), 100);
}

TEST(BondRelaxation, NeverLeavesTheRangeOfItsTemperatures) {
  // Steps of every size, from frozen to equilibrium and back.
  BondRelaxation bond(kNominal, kGlass, kZero + 20);
  double T = kZero + 20, low = T, high = T;
  for (int i = 0; i < 400; ++i) {
    const double next = kZero + 40 + 60 * std::sin(1.7 * i);
    const double duration = std::pow(10.0, 4 * std::sin(0.9 * i));
    low = std::min(low, next);
    high = std::max(high, next);
    bond.advance(T, next, duration);
    T = next;
    for (const double mode : bond.modes()) {
      ASSERT_GE(mode, low - 1e-9);  // roundoff of sums at 300 K
      ASSERT_LE(mode, high + 1e-9);
    }
  }
}

TEST(BondRelaxation, DoesNotDependOnHowAHistoryIsCutIntoSteps) {
  BondRelaxation whole(kNominal, kGlass, kZero + 70), parts = whole;
  whole.advance(kZero + 70, kZero + 20, 3000);
  constexpr int kParts = 97;
  for (int i = 0; i < kParts; ++i)
    parts.advance(kZero + 70 - 50.0 * i / kParts,
                  kZero + 70 - 50.0 * (i + 1) / kParts, 3000.0 / kParts);
  EXPECT_NEAR(whole.fictive_temperature(), parts.fictive_temperature(), 1e-3);
}

}  // namespace
}  // namespace beamgyro::internal::bond_relaxation_test
