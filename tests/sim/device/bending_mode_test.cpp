// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/device/projected_beam.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::bending_mode_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLength = 0.040, kSide = 0.003;  // [m]
constexpr double kModulus = 185e9;                // [Pa]
constexpr double kDensity = 8050;                 // [kg/m3]
constexpr double kPoisson = 0.33;

// The bare nominal beam in n equal elements.
std::vector<BeamElement> euler_beam(int n) {
  const double area = kSide * kSide;
  return std::vector<BeamElement>(
      static_cast<std::size_t>(n),
      {.length = kLength / n,
       .bending_stiffness = kModulus * area * area / 12,
       .shear_stiffness = std::numeric_limits<double>::infinity(),
       .line_density = kDensity * area,
       .rotary_inertia = 0});
}

std::vector<BeamElement> timoshenko_beam(int n) {
  std::vector<BeamElement> beam = euler_beam(n);
  const double area = kSide * kSide;
  const double kappa = 10 * (1 + kPoisson) / (12 + 11 * kPoisson);
  for (BeamElement& e : beam) {
    e.shear_stiffness = kappa * kModulus / (2 * (1 + kPoisson)) * area;
    e.rotary_inertia = kDensity * area * area / 12;
  }
  return beam;
}

// All modes of K phi = w^2 M phi by a dense solver, ascending w^2.
reference::SymmetricModes dense_modes(
    const std::vector<BeamElement>& elements) {
  const BeamMatrices beam = assemble_beam(elements);
  return reference::symmetric_modes(beam.stiffness.dense(), beam.mass.dense());
}

// b L of an eigenvalue w^2 of the bare beam.
double root(double eigenvalue) {
  const double area = kSide * kSide;
  return kLength *
         std::pow(eigenvalue * kDensity * area / (kModulus * area * area / 12),
                  0.25);
}

double frequency(const std::vector<BeamElement>& beam) {  // [Hz]
  return first_bending_mode(beam).angular_frequency / (2 * std::numbers::pi);
}

TEST(Verification, V1ThreeBendingModesOfTheBareBeam) {
  const VectorXd eigenvalues = dense_modes(euler_beam(40)).values;
  EXPECT_NEAR(root(eigenvalues(2)) / 4.7300407, 1, 1e-6);
  EXPECT_NEAR(root(eigenvalues(3)) / 7.8532046, 1, 1e-6);
  EXPECT_NEAR(root(eigenvalues(4)) / 10.9956078, 1, 3e-6);
}

TEST(Verification, V2FrequencyConvergesWithTheFourthPowerOfTheElement) {
  const auto error = [](int n) {
    const double w = first_bending_mode(euler_beam(n)).angular_frequency;
    return root(w * w) - kFreeFreeRoot;
  };
  EXPECT_GT(error(10) / error(20), 14);
  EXPECT_LT(error(10) / error(20), 18);
  EXPECT_GT(error(20) / error(40), 14);
  EXPECT_LT(error(20) / error(40), 18);
}

TEST(Verification, V3ShapeOfTheBareBeam) {
  const std::vector<BeamElement> beam = euler_beam(80);
  const VectorXd shape = first_bending_mode(beam).shape;
  ShapeIntegrals sum;
  for (int k = 0; k < 80; ++k) {
    const ShapeIntegrals part = shape_integrals(shape, k, kLength / 80);
    sum.slope_squared += part.slope_squared;
    sum.curvature_squared += part.curvature_squared;
  }
  EXPECT_NEAR(kLength * sum.slope_squared, 12.370206, 1e-5 * 12.37);
  EXPECT_NEAR(std::pow(kLength, 3) * sum.curvature_squared, 125.140975,
              1e-5 * 125.1);
  EXPECT_NEAR(shape(80), -0.6078222, 1e-5);  // in the middle
}

TEST(Verification, V3NodeOfTheUniformBeam) {
  constexpr double kNode = 0.22415752;  // [-], of the length
  std::vector<BeamElement> beam = euler_beam(80);
  for (std::size_t k = 0; k < 80; ++k)
    beam[k].length =
        kLength * (k < 20 || k >= 60 ? kNode / 20 : (1 - 2 * kNode) / 40);
  const VectorXd shape = first_bending_mode(beam).shape;
  EXPECT_NEAR(shape(40), 0, 1e-5 * 3.95);
  EXPECT_NEAR(kLength * shape(41), -3.951106, 1e-5 * 3.95);
}

TEST(Verification, V4TwoRigidModesAndABendingModeThatMovesNothing) {
  const std::vector<BeamElement> beam = euler_beam(40);
  const auto modes = dense_modes(beam);
  const double first = std::sqrt(modes.values(2));
  for (int i = 0; i < 2; ++i)
    EXPECT_LT(std::sqrt(std::abs(modes.values(i))) / first, 1e-3);
  EXPECT_GT(modes.values(2), 0);

  VectorXd shift(82), turn(82);
  for (int i = 0; i <= 40; ++i) {
    shift.segment<2>(2 * i) << 1, 0;
    turn.segment<2>(2 * i) << i * kLength / 40, 1;
  }
  const BeamMatrices matrices = assemble_beam(beam);
  const VectorXd shape = first_bending_mode(beam).shape;
  const VectorXd K_shape = matrices.stiffness * shape;
  const VectorXd M_shape = matrices.mass * shape;
  for (const VectorXd& rigid : {shift, turn}) {
    EXPECT_LT((matrices.stiffness * rigid).norm(),
              1e-9 * matrices.stiffness.dense().norm() * rigid.norm());
    const double inertia =
        std::sqrt(rigid.dot(matrices.mass * rigid) * shape.dot(M_shape));
    EXPECT_LT(std::abs(rigid.dot(M_shape)) / inertia, 1e-9);
  }
}

TEST(Verification, V5TimoshenkoFrequencyOfTheBareBeam) {
  EXPECT_NEAR(frequency(timoshenko_beam(80)) / 9056.437, 1, 1e-5);
}

TEST(Verification, V6StiffShearWithoutRotaryInertiaIsEulerBernoulli) {
  std::vector<BeamElement> beam = timoshenko_beam(80);
  for (BeamElement& e : beam) {
    e.shear_stiffness *= 1e9;
    e.rotary_inertia = 0;
  }
  EXPECT_NEAR(frequency(beam) / 9239.500, 1, 1e-6);
}

TEST(BendingMode, InverseIterationFindsTheModeOfTheDenseSolver) {
  std::vector<BeamElement> beam = timoshenko_beam(24);
  for (std::size_t k = 8; k < 16; ++k) {  // a stepped beam
    beam[k].bending_stiffness *= 1.3;
    beam[k].line_density *= 1.2;
  }
  const auto dense = dense_modes(beam);
  const BendingMode mode = first_bending_mode(beam);
  EXPECT_NEAR(mode.angular_frequency / std::sqrt(dense.values(2)), 1, 1e-9);
  const VectorXd shape = dense.vectors.col(2) / dense.vectors(0, 2);
  EXPECT_LT((mode.shape - shape).norm(), 1e-7 * shape.norm());
}

TEST(BendingMode, MassOfTheBeamIsThatOfItsRigidTranslation) {
  const BeamMatrices beam = assemble_beam(timoshenko_beam(12));
  VectorXd shift = VectorXd::Zero(26);
  for (int i = 0; i < 26; i += 2) shift(i) = 1;
  EXPECT_NEAR(shift.dot(beam.mass * shift), kDensity * kSide * kSide * kLength,
              1e-15);
}

}  // namespace
}  // namespace beamgyro::internal::bending_mode_test
