// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "sim/memory/unit_memory.h"

namespace beamgyro::internal::ageing_test {
namespace {

constexpr double kHour = 3600, kDay = 24 * kHour;
constexpr AgeingParameters kNominal{.activation = 5e4,
                                    .start = kDay,
                                    .trim_age = 0,
                                    .patch_modulus = 2e-3,
                                    .d31 = -5e-3,
                                    .permittivity = -1e-2,
                                    .mechanical_loss = -5e-2,
                                    .bond_modulus = 3e-3,
                                    .mount_share = 1e-2};

TEST(V54Ageing, IsLinearInTheLogarithmOverTenDecades) {
  for (int decade = 0; decade <= 10; ++decade) {
    Ageing age(kNominal, 0);
    // t_e + t_1 is 10^decade times t_1.
    age.advance(kAgeingTemperature, kAgeingTemperature,
                kDay * (std::pow(10.0, decade) - 1));
    EXPECT_NEAR(age.decades(), decade, 1e-9);
  }
}

TEST(V54Ageing, IsFasterWhenItIsWarm) {
  EXPECT_NEAR(ageing_rate(5e4, 333.15), 8.3227, 1e-3);
  EXPECT_DOUBLE_EQ(ageing_rate(5e4, kAgeingTemperature), 1);
  Ageing age(kNominal, 0);
  age.advance(333.15, 333.15, 1000 * kHour);
  EXPECT_NEAR(age.effective_age() / (1000 * kHour), 8.3227, 1e-3);
}

TEST(Ageing, TrimsHoldAtTheAgeOfTheTrim) {
  AgeingParameters parameters = kNominal;
  parameters.trim_age = 168 * kHour;
  EXPECT_EQ(Ageing(parameters, parameters.trim_age).decades(), 0);
  EXPECT_LT(Ageing(parameters, 0).decades(), 0);
}

TEST(Ageing, OverARampIsTheIntegralOfItsRate) {
  Ageing ramp(kNominal, 0);
  ramp.advance(233.15, 363.15, 1000);
  double sum = 0;  // the midpoint rule, exact to 1e-8
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i)
    sum += ageing_rate(5e4, 233.15 + 130 * (i + 0.5) / kSteps) * 1000 / kSteps;
  EXPECT_NEAR(ramp.effective_age() / sum, 1, 1e-5);
}

}  // namespace
}  // namespace beamgyro::internal::ageing_test
