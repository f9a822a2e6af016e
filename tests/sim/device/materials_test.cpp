// SPDX-License-Identifier: MIT
#include "sim/device/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::materials_test {
namespace {

constexpr double kDriveOmega = 2 * std::numbers::pi * 9081.5;  // [rad/s]

// Where `loss` has its maximum in [low, high], by golden section.
template <class Loss>
double peak(double low, double high, Loss loss) {
  constexpr double kGolden = 0.6180339887498949;
  while (high - low > 1e-6) {
    const double a = high - kGolden * (high - low);
    const double b = low + kGolden * (high - low);
    (loss(a) > loss(b) ? high : low) = loss(a) > loss(b) ? b : a;
  }
  return 0.5 * (low + high);
}

TEST(Verification, V9ShearLagLimits) {
  for (const double q : {30.0, 100.0, 1e4})
    EXPECT_NEAR(shear_lag(Complex(q)).real() / (1 - 1 / q), 1, 1e-6);
  for (const double q : {1e-2, 1e-3, 1e-5})
    EXPECT_NEAR(shear_lag(Complex(q)).real() / (q * q / 3), 1, 1e-4 * q / 1e-2);
  const Complex tiny = shear_lag(std::polar(1e-4, 0.3));
  EXPECT_NEAR(std::abs(tiny / (std::polar(1e-8, 0.6) / 3.0) - 1.0), 0, 1e-6);
}

TEST(Materials, ShearLagSeriesMeetsTheClosedForm) {
  for (const double angle : {0.0, 0.4, 0.7}) {
    const Complex below = std::polar(0.019999, angle);
    const Complex closed = 1.0 - std::tanh(below) / below;
    EXPECT_NEAR(std::abs(shear_lag(below) / closed - 1.0), 0, 1e-11);
  }
}

TEST(Verification, V10BondStiffensWithFrequency) {
  const BondParameters bond = nominal_device().bond;
  for (double T = 213.15; T <= 373.15; T += 5) {
    double below = 0;
    for (double omega = 1; omega < 1e7; omega *= 3) {
      const Complex G = bond_modulus(bond, T, omega);
      EXPECT_GT(G.real(), below) << T << " K, " << omega << " rad/s";
      EXPECT_GT(G.imag(), 0) << T << " K, " << omega << " rad/s";
      below = G.real();
    }
  }
}

TEST(Verification, V11BetaLossPeaksAtTheDriveFrequencyNear10DegC) {
  BondParameters bond = nominal_device().bond;
  bond.alpha_step = 0;
  const double T = peak(250, 320, [&](double t) {
    return bond_modulus(bond, t, kDriveOmega).imag();
  });
  EXPECT_NEAR(T - kZeroCelsius, 10.5, 0.2);
}

TEST(Verification, V12MountRelaxesAtTheDriveFrequency) {
  const MountParameters mount = nominal_device().mount;
  double cold = 240, hot = 290;  // w tau = 1 by bisection
  for (int i = 0; i < 60; ++i) {
    const double T = 0.5 * (cold + hot);
    const double wt =
        kDriveOmega *
        glass_time_constant(T, mount.glass_transition, mount.low_activation);
    (wt > 1 ? cold : hot) = T;
  }
  EXPECT_NEAR(cold - kZeroCelsius, -15.37, 0.05);
}

TEST(Verification, V13ThermoelasticLossAt25DegC) {
  EXPECT_NEAR(
      thermoelastic_loss(nominal_device().beam, 298.15, kDriveOmega) / 4.53e-8,
      1, 0.01);
}

TEST(Materials, GlassTimeConstantIsContinuousAtTheTransition) {
  const double tau = glass_time_constant(300, 300, 4e5);
  EXPECT_EQ(tau, 100);
  EXPECT_NEAR(glass_time_constant(300 - 1e-9, 300, 4e5) / tau, 1, 1e-8);
  EXPECT_LT(glass_time_constant(310, 300, 4e5), 1);
  EXPECT_GT(glass_time_constant(290, 300, 4e5), 1e4);
}

TEST(Materials, MountIsRubberWhenHotAndGlassWhenCold) {
  const MountParameters mount = nominal_device().mount;
  const Complex cold = mount_share(mount, 223.15, kDriveOmega);
  const Complex hot = mount_share(mount, 423.15, kDriveOmega);
  EXPECT_NEAR(cold.real() / mount.glassy_stiffness_share, 1, 0.01);
  EXPECT_NEAR(
      hot.real() / (mount.glassy_stiffness_share * mount.rubber_glass_ratio), 1,
      0.05);
}

TEST(Materials, CeramicCoefficientsAreHeldOutsideTheirRange) {
  const PatchParameters patches = nominal_device().patches;
  EXPECT_EQ(patch_modulus(patches, 213.15), patch_modulus(patches, 233.15));
  EXPECT_EQ(patch_modulus(patches, 373.15), patch_modulus(patches, 353.15));
  EXPECT_NE(patch_modulus(patches, 243.15), patch_modulus(patches, 233.15));
}

}  // namespace
}  // namespace beamgyro::internal::materials_test
