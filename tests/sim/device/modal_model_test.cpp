// SPDX-License-Identifier: MIT
#include "sim/device/modal_model.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::modal_model_test {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;

constexpr double kHertz = 2 * std::numbers::pi;  // [rad/s]
constexpr double kT0 = kCalibrationTemperature;

TEST(Verification, V7VoltageToForceEqualsDisplacementToCharge) {
  const DeviceParameters device = nominal_device();
  const CompositeBeam mesh = composite_beam(device, kBeamElements);
  std::vector<BeamElement> euler = mesh.elements;
  for (BeamElement& e : euler) {
    e.shear_stiffness = std::numeric_limits<double>::infinity();
    e.rotary_inertia = 0;
  }
  const Eigen::VectorXd shape = first_bending_mode(euler).shape;
  const ProjectedBeam beam = project_beam(device);
  const double lever = std::abs(
      piezo_stress_constant(device.patches, kT0) * device.patches.width *
      shear_lag(device.patches, device.bond.thickness[kDrive],
                bond_modulus(device.bond, kT0, beam.timoshenko_frequency),
                patch_modulus(device.patches, kT0)));
  const double h = patch_position(device, kDrive)(0);

  // One volt makes the end moments +-lever h at the patch edges, which work on
  // the mode's slope there.
  Eigen::Index first = -1, last = -1;
  for (std::size_t k = 0; k < euler.size(); ++k) {
    if (!mesh.under_patches[k]) continue;
    if (first < 0) first = static_cast<Eigen::Index>(k);
    last = static_cast<Eigen::Index>(k);
  }
  const double force = lever * h * (shape(2 * last + 3) - shape(2 * first + 1));
  // One metre of tip displacement makes the charge lever int S dz, with the
  // strain S = h phi'' from the curvatures at the element ends.
  double charge = 0;
  for (Eigen::Index k = first; k <= last; ++k) {
    const double dz = euler[static_cast<std::size_t>(k)].length;
    const double w1 = shape(2 * k), t1 = dz * shape(2 * k + 1);
    const double w2 = shape(2 * k + 2), t2 = dz * shape(2 * k + 3);
    const double start = (6 * (w2 - w1) - 4 * t1 - 2 * t2) / (dz * dz);
    const double end = (6 * (w1 - w2) + 2 * t1 + 4 * t2) / (dz * dz);
    charge += lever * h * dz * 0.5 * (start + end);
  }
  EXPECT_NEAR(charge / force, 1, 1e-12);
  EXPECT_NEAR(std::abs(patch_coupling(device, beam, kDrive, kT0)(0)) / force, 1,
              1e-9);
}

TEST(Verification, V8OpenCircuitStiffeningOfEachPatch) {
  const DeviceParameters device = verification_device();
  const ProjectedBeam beam = project_beam(device);
  const ModalParameters modal = modal_parameters(device, beam, kT0, 0);
  const double C = patch_capacitance(device.patches, kT0);
  EXPECT_NEAR(C, 1.27e-9, 0.005e-9);

  const double expected[] = {19.42, 19.64, 19.23, 19.47};  // [Hz]
  for (std::size_t p = 0; p < kPatchCount; ++p) {
    const Eigen::Index axis = p < 2 ? 0 : 1;
    // The stiffness common to both planes; the split adds 1.6 % to k_yy.
    const double k = modal.stiffness(0, 0);
    const double theta = modal.coupling[p](axis).real();
    // Force and no charge on [k, -theta; theta, C]: what one newton moves.
    Matrix2d port;
    port << k, -theta, theta, C;
    const double open =
        1 / reference::solution(port, Eigen::Vector2d(1, 0))(0, 0);
    EXPECT_NEAR((open - k) / (theta * theta / C), 1, 1e-6);
    const double f = 9081.5;  // [Hz]
    EXPECT_NEAR(f * (std::sqrt(open / k) - 1), expected[p], 0.05) << p;
  }
}

TEST(Verification, V10LossOfTheStiffnessIsPositiveDefiniteAtAllTemperatures) {
  const DeviceParameters device = nominal_device();
  const ProjectedBeam beam = project_beam(device);
  for (double T = 213.15; T <= 373.15; T += 1) {
    const Matrix2d loss = modal_parameters(device, beam, T, 0).damping;
    EXPECT_GT(reference::symmetric_modes(loss).values(0), 0) << T << " K";
  }
}

TEST(ModalModel, NominalCompositeBeam) {
  const ProjectedBeam beam = project_beam(nominal_device());
  EXPECT_NEAR(beam.euler_frequency / kHertz, 9346.3, 0.05);
  EXPECT_NEAR(beam.timoshenko_frequency / kHertz, 9156.366, 0.001);
  EXPECT_NEAR(beam.mass, 7.1786e-4, 5e-9);
  EXPECT_NEAR(beam.curvature_squared, 1.8157e6, 100);
  EXPECT_NEAR(beam.patch_curvature_squared / beam.curvature_squared, 0.611,
              5e-4);
  EXPECT_NEAR(beam.patch_curvature, 115.18, 0.005);
  EXPECT_NEAR(beam.stiffness_scale, 0.95978, 5e-6);
}

TEST(ModalModel, RotaryInertiaTakesTwoPercentOfTheCoriolisMass) {
  // 1/(1 + 49.48 (r/L)^2) of the bare beam; the patches add more translating
  // than rotating mass.
  const double bare = 1 / (1 + 49.48 * 9e-6 / 12 / 1.6e-3);
  EXPECT_NEAR(project_beam(nominal_device()).angular_gain, bare, 2e-3);
  EXPECT_EQ(project_beam(verification_device()).angular_gain, 1);
}

TEST(ModalModel, CoarserMeshesApproachTheModel) {
  const DeviceParameters device = nominal_device();
  const double fine = project_beam(device, 480).timoshenko_frequency;
  const double at_60 = project_beam(device, 60).timoshenko_frequency - fine;
  const double at_120 = project_beam(device, 120).timoshenko_frequency - fine;
  EXPECT_NEAR(at_60 / at_120, 4, 0.5);  // second order in the element
  EXPECT_LT(std::abs(at_120 / fine), 1e-5);
}

TEST(ModalModel, PinsStiffenBothModesAlikeWhenTheHousingGrowsMore) {
  const DeviceParameters loose = nominal_device();
  const DeviceParameters clamped =
      nominal_device({"mount.pin_stiffness_N_per_m=2e4"});
  const ProjectedBeam beam = project_beam(loose);
  const auto shift = [&](double T) {
    return Matrix2d(modal_parameters(clamped, beam, T, 0).stiffness -
                    modal_parameters(loose, beam, T, 0).stiffness);
  };
  EXPECT_EQ(shift(kT0).norm(), 0);
  const Matrix2d hot = shift(kT0 + 25);
  EXPECT_GT(hot(0, 0), 0);
  EXPECT_NEAR(hot(0, 0) / hot(1, 1), 1, 1e-9);
  EXPECT_EQ(hot(0, 1), 0);
  // 26.0 % of int phi'^2 lies between the pins of the bare beam; the patches
  // stiffen its middle.
  const double tension = 2e4 * (23e-6 - 7.6e-6) * 25 * 0.538 * 0.040;
  EXPECT_NEAR(hot(0, 0), 0.26 * 12.37 / 0.040 * tension, 0.15 * hot(0, 0));
}

TEST(ModalModel, AnActiveMaterialIsRefused) {
  DeviceParameters device = nominal_device();
  device.beam.loss_factor = -0.01;
  const ProjectedBeam beam = project_beam(device);
  EXPECT_THROW(modal_parameters(device, beam, kT0, 0), std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::internal::modal_model_test
