// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "sim/dynamics/envelope.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::slow_manifold_test {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Matrix4cd;
using Eigen::Vector2cd;
using Eigen::Vector4cd;

constexpr std::complex<double> kI(0, 1);

// Two modes of mass 1 near w_0 = 1; every small quantity shrinks with eps.
struct ScaledModes {
  Matrix2d stiffness, velocity;

  explicit ScaledModes(double eps) {
    const double rate = 0.03 * eps, split = 0.06 * eps;
    stiffness << 1, 0.03 * eps, 0.03 * eps, std::pow(1 + split, 2);
    stiffness -= rate * rate * Matrix2d::Identity();
    velocity << 0.04 * eps, 0.008 * eps - 2 * rate, 0.008 * eps + 2 * rate,
        0.05 * eps;
  }
  Matrix2cd rate_matrix() const {
    return 2.0 * kI * Matrix2cd::Identity() + velocity;
  }
  Matrix2cd stiffness_matrix() const {
    return stiffness - Matrix2d::Identity() + kI * velocity;
  }

  // Decay matrix of the exact slow manifold: L^2 - P L + S = 0.
  Matrix2cd exact_decay() const {
    Matrix2cd L = Matrix2cd::Zero();
    for (int i = 0; i < 200; ++i)
      L = reference::solution(rate_matrix(), stiffness_matrix() + L * L);
    return L;
  }

  // Error of u' = A u at 50/eps against the vibration itself, started on the
  // exact slow manifold.
  double error(const Matrix2cd& A, double eps) const {
    const double t = 50 / eps;
    const Vector2cd u0(1.0, 0.2 * kI);
    Vector4cd start;
    start << u0, kI * u0 - exact_decay() * u0;
    Matrix4cd system = Matrix4cd::Zero();
    system.topRightCorner<2, 2>().setIdentity();
    system.bottomLeftCorner<2, 2>() = -stiffness;
    system.bottomRightCorner<2, 2>() = -velocity;
    const Vector4cd end = Matrix4cd(reference::exponential(system * t)) * start;
    const Vector2cd exact = std::exp(-kI * t) * end.head<2>();
    const Vector2cd model = Matrix2cd(reference::exponential(A * t)) * u0;
    return (model - exact).norm() / exact.norm();
  }
};

struct Errors {
  double averaged, first, second;
};

Errors errors(double eps) {
  const ScaledModes modes(eps);
  const Matrix2cd averaged = -modes.stiffness_matrix() / (2.0 * kI);
  const Matrix2cd first =
      -reference::solution(modes.rate_matrix(), modes.stiffness_matrix());
  const EnvelopePlant plant(modes.stiffness, modes.velocity, 1.0);
  return {modes.error(averaged, eps), modes.error(first, eps),
          modes.error(plant.from_amplitude(), eps)};
}

TEST(Verification, V21EnvelopeOfFirstAndOfSecondOrder) {
  const Errors coarse = errors(1), fine = errors(0.125);
  EXPECT_NEAR(coarse.averaged / 3.09e-2, 1, 0.05);
  EXPECT_NEAR(fine.averaged / 4.07e-3, 1, 0.05);
  EXPECT_NEAR(coarse.first / 6.80e-2, 1, 0.05);
  EXPECT_NEAR(fine.first / 9.07e-3, 1, 0.05);
  EXPECT_NEAR(coarse.second / 5.80e-3, 1, 0.05);
  EXPECT_NEAR(fine.second / 8.96e-5, 1, 0.05);
}

TEST(Verification, V21OrdersAreOneAndTwo) {
  const Errors a = errors(0.25), b = errors(0.125);
  EXPECT_NEAR(std::log2(a.averaged / b.averaged), 1, 0.05);
  EXPECT_NEAR(std::log2(a.first / b.first), 1, 0.05);
  EXPECT_NEAR(std::log2(a.second / b.second), 2, 0.05);
}

}  // namespace
}  // namespace beamgyro::internal::slow_manifold_test
