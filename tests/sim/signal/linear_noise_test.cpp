// SPDX-License-Identifier: MIT
#include "sim/signal/linear_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <string>

#include "random/random_stream.h"
#include "tests/config/rejection.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::linear_noise_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

RandomStream stream(std::uint32_t run = 0) {
  return {7, 0, run, kMechanicalNoiseStream};
}

MatrixXd square(const MatrixXd& root) { return root * root.transpose(); }

// Largest error of a covariance, each element beside its states' deviations.
double error(const MatrixXd& covariance, const MatrixXd& expected) {
  const VectorXd sigma = expected.diagonal().cwiseSqrt();
  return ((covariance - expected).array() / (sigma * sigma.transpose()).array())
      .abs()
      .maxCoeff();
}

MatrixXd normal_matrix(Index rows, Index columns, std::uint32_t run) {
  RandomStream numbers = stream(run);
  MatrixXd matrix(rows, columns);
  for (double& value : matrix.reshaped()) value = numbers.normal();
  return matrix;
}

// Eight coupled states that decay within seconds.
NoiseSystem coupled_system() {
  MatrixXd A = normal_matrix(8, 8, 1);
  A -= (A.norm() + 0.5) * MatrixXd::Identity(8, 8);
  return {A, normal_matrix(8, 3, 2)};
}

// Decays from 0.1 to 2000 1/s behind one noise, mixed by an orthogonal matrix.
struct StiffSystem {
  VectorXd decay{{0.1, 0.7, 5.0, 37.0, 300.0, 2000.0}};
  VectorXd drive{{1.0, 0.5, -2.0, 3.0, 1.5, -4.0}};
  MatrixXd mix =
      reference::symmetric_modes(square(normal_matrix(6, 6, 3))).vectors;
  NoiseSystem system = {mix * MatrixXd((-decay).asDiagonal()) * mix.transpose(),
                        mix* drive};

  // int_0^h of the products of two decays; h = inf: stationary.
  MatrixXd covariance(double h) const {
    MatrixXd Q(6, 6);
    for (Index i = 0; i < 6; ++i)
      for (Index j = 0; j < 6; ++j)
        Q(i, j) = -drive(i) * drive(j) *
                  std::expm1(-(decay(i) + decay(j)) * h) /
                  (decay(i) + decay(j));
    return Q;
  }
};

SampledNoise van_loan(const NoiseSystem& system, double h) {
  const Index n = system.A.rows();
  MatrixXd block = MatrixXd::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -system.A * h;
  block.topRightCorner(n, n) = square(system.B) * h;
  block.bottomRightCorner(n, n) = system.A.transpose() * h;
  const MatrixXd e = reference::exponential(block);
  const MatrixXd Phi = e.bottomRightCorner(n, n).transpose();
  return {Phi, Phi * e.topRightCorner(n, n)};  // the covariance for the root
}

TEST(LinearNoise, GrowthIsTheLargestRealPartOfTheEigenvalues) {
  NoiseSystem system{Eigen::MatrixXd(3, 3), Eigen::MatrixXd::Ones(3, 1)};
  // A pair of 0.3 +- 2e3 i, in states of unlike units, and a decay.
  system.A << 0.3, 2e6, 0, -2, 0.3, 0, 0, 0, -5;
  EXPECT_NEAR(growth_rate(system), 0.3, 1e-9);
  system.A.topLeftCorner(2, 2).diagonal().setConstant(-7);
  EXPECT_NEAR(growth_rate(system), -5, 1e-9);
}

TEST(SampledNoise, OneDecayHasItsClosedForm) {
  for (double a : {0.1, 37.0, 2000.0}) {
    for (double h : {5e-4, 0.1, 1.0}) {
      const NoiseSystem system{MatrixXd::Constant(1, 1, -a),
                               MatrixXd::Constant(1, 1, 3e-9)};
      const SampledNoise s = sampled_noise(system, h);
      EXPECT_NEAR(s.transition(0, 0), std::exp(-a * h), 1e-13);
      const double expected = 3e-9 * std::sqrt(-std::expm1(-2 * a * h) / 2 / a);
      EXPECT_NEAR(s.root(0, 0) / expected, 1.0, 1e-13) << a << " " << h;
      EXPECT_NEAR(stationary_root(system)(0, 0) / (3e-9 / std::sqrt(2 * a)),
                  1.0, 1e-13);
    }
  }
}

TEST(SampledNoise, DampedOscillatorHasItsClosedForm) {
  const double w = 447.0, a = 37.6, s = 2.0;  // decay a, damped frequency nu
  const double nu = std::sqrt(w * w - a * a);
  NoiseSystem system{MatrixXd{{0.0, 1.0}, {-w * w, -2 * a}},
                     MatrixXd{{0.0}, {s}}};
  const MatrixXd stationary{{s * s / (4 * a * w * w), 0.0},
                            {0.0, s * s / (4 * a)}};
  EXPECT_LT(error(square(stationary_root(system)), stationary), 1e-12);
  for (double h : {2e-3, 0.01, 0.1}) {
    const double e = std::exp(-a * h), c = std::cos(nu * h),
                 i = std::sin(nu * h);
    const MatrixXd Phi{{e * (c + a / nu * i), e * i / nu},
                       {-e * w * w / nu * i, e * (c - a / nu * i)}};
    const SampledNoise sampled = sampled_noise(system, h);
    EXPECT_LT(((sampled.transition - Phi).array() /
               MatrixXd{{1.0, 1 / w}, {w, 1.0}}.array())
                  .abs()
                  .maxCoeff(),
              1e-12);
    EXPECT_LT(error(square(sampled.root),
                    stationary - Phi * stationary * Phi.transpose()),
              1e-11)
        << h;
  }
}

TEST(SampledNoise, AChainOfIntegratorsHasItsClosedFormInEveryElement) {
  constexpr Index kStates = 7;
  for (double h : {1e-3, 0.2, 50.0}) {
    NoiseSystem system{MatrixXd::Zero(kStates, kStates),
                       MatrixXd::Zero(kStates, 1)};
    system.B(0, 0) = 1.0;
    for (Index i = 1; i < kStates; ++i) system.A(i, i - 1) = 1.0;
    const SampledNoise sampled = sampled_noise(system, h);
    const MatrixXd Q = square(sampled.root);
    for (Index i = 0; i < kStates; ++i) {
      for (Index j = 0; j < kStates; ++j) {
        const auto p = static_cast<double>(i), q = static_cast<double>(j);
        const double expected = std::pow(h, p + q + 1) / std::tgamma(p + 1) /
                                std::tgamma(q + 1) / (p + q + 1);
        EXPECT_NEAR(Q(i, j) / expected, 1.0, 1e-12) << i << j << h;
        if (i < j) continue;
        EXPECT_NEAR(sampled.transition(i, j) * std::tgamma(p - q + 1) /
                        std::pow(h, p - q),
                    1.0, 1e-12);
      }
    }
  }
}

TEST(SampledNoise, AgreesWithVanLoanWhereThatIsWellConditioned) {
  const NoiseSystem system = coupled_system();
  for (double h : {1e-3, 0.01, 0.1, 0.5}) {
    const SampledNoise sampled = sampled_noise(system, h);
    const SampledNoise direct = van_loan(system, h);
    EXPECT_LT((sampled.transition - direct.transition).cwiseAbs().maxCoeff(),
              1e-13);
    EXPECT_LT(error(square(sampled.root), direct.root), 1e-10) << h;
  }
}

TEST(SampledNoise, KeepsItsDigitsWhereVanLoanLosesThem) {
  const StiffSystem stiff;
  EXPECT_FALSE(van_loan(stiff.system, 1.0).root.allFinite());
  for (double h : {5e-4, 0.01, 0.1, 1.0}) {
    const SampledNoise sampled = sampled_noise(stiff.system, h);
    const MatrixXd modal = stiff.mix.transpose() * sampled.root;
    EXPECT_LT(error(square(modal), stiff.covariance(h)), 1e-11) << h;
    const MatrixXd Phi = stiff.mix.transpose() * sampled.transition * stiff.mix;
    const MatrixXd decayed =
        VectorXd((-stiff.decay * h).array().exp()).asDiagonal();
    EXPECT_LT((Phi - decayed).cwiseAbs().maxCoeff(), 1e-12) << h;
  }
}

TEST(SampledNoise, DoesNotDependOnTheUnitsOfTheStates) {
  const NoiseSystem system = coupled_system();
  const VectorXd unit{{1e-14, 3.0, 1e9, 1e-4, 7e5, 1e-30, 1e20, 0.2}};
  const MatrixXd D = unit.asDiagonal(),
                 inverse = unit.cwiseInverse().asDiagonal();
  const NoiseSystem scaled{D * system.A * inverse, D * system.B};
  const SampledNoise a = sampled_noise(system, 0.3),
                     b = sampled_noise(scaled, 0.3);
  EXPECT_LT((inverse * b.root - a.root).norm(), 1e-12 * a.root.norm());
  EXPECT_LT((inverse * b.transition * D - a.transition).norm(), 1e-13);
  EXPECT_LT(
      (inverse * stationary_root(scaled) - stationary_root(system)).norm(),
      1e-12 * a.root.norm());
}

TEST(SampledNoise, NoiseOfLowRankLeavesUndrivenStatesAlone) {
  // A pair that noise turns in one direction only, and a state without noise.
  const NoiseSystem system{
      MatrixXd{{-1.0, 0.0, 2.0}, {0.0, -1.0, -1.0}, {0.0, 0.0, -3.0}},
      MatrixXd{{1.0, 2.0}, {2.0, 4.0}, {0.0, 0.0}}};
  for (const MatrixXd& root :
       {sampled_noise(system, 0.4).root, stationary_root(system)}) {
    EXPECT_TRUE(root.allFinite());
    EXPECT_EQ(root.row(2).norm(), 0.0);
    EXPECT_GT(root(0, 0), 0.0);
    EXPECT_LT((root.row(1) - 2 * root.row(0)).norm(), 1e-14);
  }
}

TEST(StationaryRoot, SolvesTheLyapunovEquation) {
  for (const NoiseSystem& system : {coupled_system(), StiffSystem().system}) {
    const MatrixXd Sigma = square(stationary_root(system));
    const MatrixXd flow = system.A * Sigma;
    const MatrixXd residual = flow + flow.transpose() + square(system.B);
    EXPECT_LT(residual.norm(), 1e-12 * square(system.B).norm());
  }
  const StiffSystem stiff;
  EXPECT_LT(error(square(stiff.mix.transpose() * stationary_root(stiff.system)),
                  stiff.covariance(std::numeric_limits<double>::infinity())),
            1e-11);
}

TEST(StationaryRoot, IsKeptByStepsOfAnyLength) {
  const StiffSystem stiff;
  const MatrixXd root = stationary_root(stiff.system);
  for (double h : {5e-4, 0.01, 1.0, 30.0}) {
    const SampledNoise sampled = sampled_noise(stiff.system, h);
    EXPECT_LT(error(square(sampled.transition * root) + square(sampled.root),
                    square(root)),
              1e-12)
        << h;
  }
}

TEST(LinearNoise, StartsStationary) {
  const NoiseSystem system{MatrixXd{{-3.0, 5.0}, {-4.0, -1.0}},
                           MatrixXd{{1.0}, {0.5}}};
  constexpr std::uint32_t kRuns = 4000;
  MatrixXd sum = MatrixXd::Zero(2, 2);
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    const LinearNoise noise(system, 1e-3, stream(run));
    sum += square(noise.state());
  }
  // An element of a sample covariance has a deviation of at most
  // sqrt(2/runs) sigma_i sigma_j.
  EXPECT_LT(error(sum / kRuns, square(stationary_root(system))),
            3.0 * std::sqrt(2.0 / kRuns));
}

TEST(LinearNoise, FollowsItsSampledFormWithNNumbersASample) {
  const NoiseSystem system = coupled_system();
  LinearNoise noise(system, 0.05, stream());
  RandomStream numbers = stream();
  VectorXd n(8);
  const auto draw = [&] {
    for (double& value : n) value = numbers.normal();
  };
  draw();
  VectorXd z = stationary_root(system) * n;
  const SampledNoise sampled = sampled_noise(system, 0.05);
  for (int k = 0; k < 300; ++k) {
    ASSERT_LT((noise.state() - z).norm(), 1e-13) << k;
    noise.advance();
    draw();
    z = sampled.transition * z + sampled.root * n;
  }
}

TEST(LinearNoise, RefreshedCoefficientsLeaveTheStateWhereItIs) {
  const NoiseSystem system = coupled_system();
  NoiseSystem warmer = system;
  warmer.A *= 1.5;
  warmer.B = 0.7 * system.B.leftCols(2);  // one noise less
  LinearNoise steady(system, 0.05, stream()), moved = steady;
  for (int k = 0; k < 10; ++k) {
    steady.advance();
    moved.advance();
    moved.refresh(system);
  }
  EXPECT_EQ(steady.state(), moved.state());
  const VectorXd before = moved.state();
  moved.refresh(warmer);
  EXPECT_EQ(moved.state(), before);

  RandomStream numbers = stream();
  VectorXd n(8);
  for (int k = 0; k < 12; ++k)
    for (double& value : n) value = numbers.normal();
  moved.advance();
  const SampledNoise sampled = sampled_noise(warmer, 0.05);
  EXPECT_LT(
      (moved.state() - sampled.transition * before - sampled.root * n).norm(),
      1e-13);
}

std::string rejection_of(const NoiseSystem& system, double interval = 0.1) {
  return rejection([&] { LinearNoise(system, interval, stream()); });
}

TEST(LinearNoise, RejectsBadInput) {
  const MatrixXd one = MatrixXd::Ones(1, 1), two = MatrixXd::Identity(2, 2);
  MatrixXd hole = -two;
  hole(0, 1) = NAN;
  EXPECT_EQ(rejection_of({MatrixXd::Zero(2, 3), two}),
            "noise system: A is 2 x 3, must be square and not empty");
  EXPECT_EQ(rejection_of({MatrixXd(), MatrixXd()}),
            "noise system: A is 0 x 0, must be square and not empty");
  EXPECT_EQ(rejection_of({-two, one}),
            "noise system: B is 1 x 1, must have 2 rows as A, and a column for "
            "every noise");
  EXPECT_EQ(rejection_of({-two, MatrixXd(2, 0)}),
            "noise system: B is 2 x 0, must have 2 rows as A, and a column for "
            "every noise");
  EXPECT_EQ(rejection_of({hole, two}),
            "noise system: A(0, 1) is nan, must be finite");
  EXPECT_EQ(rejection_of({-two, INFINITY * MatrixXd::Ones(2, 1)}),
            "noise system: B(0, 0) is inf, must be finite");
  EXPECT_EQ(rejection_of({-one, one}, 0.0),
            "sampling interval is 0 s, must be above 0");
  EXPECT_EQ(rejection_of({-one, one}, NAN),
            "sampling interval is nan s, must be above 0");
  EXPECT_NO_THROW(LinearNoise({-one, one}, 0.1, stream()));
  EXPECT_EQ(rejection_of({0.25 * one, one}),
            "noise system has no stationary state: an eigenvalue of A has real "
            "part 0.25 1/s, must be below 0");
  EXPECT_EQ(rejection_of({2e3 * one, one}, 10.0),
            "noise system grows beyond all numbers within the sampling "
            "interval of 10 s");
  EXPECT_EQ(rejection_of({-1e300 * one, one}, 1e10),
            "noise system: A times the sampling interval of 10000000000 s is "
            "not finite");
  LinearNoise noise({-one, one}, 0.1, stream());
  EXPECT_EQ(rejection([&] {
              noise.refresh({-two, two});
            }),
            "refreshed noise system has 2 states, must have 1");
}

}  // namespace
}  // namespace beamgyro::internal::linear_noise_test
