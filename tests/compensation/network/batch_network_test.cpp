// SPDX-License-Identifier: MIT
#include "compensation/network/batch_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/compensation/sample_compensators.h"

namespace beamgyro::internal::batch_network_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ScaledRows some_rows(Index count, Index inputs) {
  ScaledRows rows;
  rows.inputs = wavy_inputs(count, inputs);
  rows.target = rows.inputs.col(0).square() - 0.3;
  return rows;
}

const std::vector<std::vector<int>> kSizes = {
    {2, 1}, {1, 6, 1}, {3, 14, 1}, {2, 5, 4, 1}, {2, 3, 8, 5, 1}};

// Sums of the same terms in another order.
TEST(BatchNetwork, NormalEquationsAreThoseOfTheJacobian) {
  for (const std::vector<int>& sizes : kSizes) {
    for (const Index count : {1, 37, 64, 3001}) {
      const BpNetwork network = random_network(sizes, 8);
      const ScaledRows rows = some_rows(count, sizes.front());
      MatrixXd jacobian, matrix;
      VectorXd gradient;
      const VectorXd error =
          (network.predict_with_jacobian(rows.inputs, jacobian) - rows.target)
              .matrix();
      BatchNetwork batch(sizes, rows, 1);
      EXPECT_NEAR(batch.sum_of_squares(network.weights()), error.squaredNorm(),
                  1e-13 * error.squaredNorm());
      batch.normal_equations(matrix, gradient);
      const MatrixXd expected = jacobian.transpose() * jacobian;
      const MatrixXd found = matrix.selfadjointView<Eigen::Lower>();
      EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm());
      const VectorXd slope = jacobian.transpose() * error;
      EXPECT_LT((gradient - slope).norm(), 1e-12 * slope.norm());
    }
  }
}

// The second difference of a step h is off by h^2 y''''/12 and by rounding,
// 4e-16 y / h^2.
TEST(BatchNetwork, CurvatureMatchesSecondDifferences) {
  for (const std::vector<int>& sizes : kSizes) {
    const BpNetwork network = random_network(sizes, 8);
    const ScaledRows rows = some_rows(37, sizes.front());
    const VectorXd w = network.weights();
    const VectorXd v = VectorXd::NullaryExpr(
        w.size(), [](auto i) { return std::cos(2.0 * double(i)); });
    const double h = 3e-4;
    const auto output = [&](double t) {
      BpNetwork moved = network;
      moved.set_weights(w + t * v);
      return moved.predict(rows.inputs);
    };
    const VectorXd bend = (output(h) - 2.0 * output(0.0) + output(-h)) / h / h;
    MatrixXd jacobian;
    network.predict_with_jacobian(rows.inputs, jacobian);
    const VectorXd expected = jacobian.transpose() * bend;
    BatchNetwork batch(sizes, rows, 1);
    batch.sum_of_squares(w);
    EXPECT_LT((batch.curvature(v) - expected).norm(),
              1e-5 * (expected.norm() + 1e-3));
  }
}

TEST(BatchNetwork, ThreadsDoNotChangeABit) {
  const std::vector<int> sizes = {3, 14, 1};
  const VectorXd w = random_network(sizes, 8).weights();
  const ScaledRows rows = some_rows(20000, 3);
  MatrixXd one, several;
  VectorXd one_gradient, gradient;
  BatchNetwork single(sizes, rows, 1);
  const double squares = single.sum_of_squares(w);
  single.normal_equations(one, one_gradient);
  const VectorXd bend = single.curvature(w);
  for (const int threads : {2, 3, 40}) {
    BatchNetwork batch(sizes, rows, threads);
    EXPECT_EQ(batch.sum_of_squares(w), squares);
    batch.normal_equations(several, gradient);
    EXPECT_EQ(several, one);
    EXPECT_EQ(gradient, one_gradient);
    EXPECT_EQ(batch.curvature(w), bend);
  }
}

TEST(BatchNetwork, TanhIsThatOfTheLibraryToFiveUnitsInTheLastPlace) {
  alignas(32) double z[kLanes];
  const auto expect_near = [&](double x) {
    std::fill_n(z, kLanes, x);
    tanh_in_place(z, kLanes);
    EXPECT_NEAR(z[0], std::tanh(x), 5 * 2.3e-16 * std::abs(std::tanh(x))) << x;
    for (Index k = 1; k < kLanes; ++k) EXPECT_EQ(z[k], z[0]);
  };
  for (double x = -25.0; x < 25.0; x += 1.3e-3) expect_near(x);
  for (double x = 1e-300; x < 1.0; x *= 7.0) expect_near(x);
  expect_near(std::numeric_limits<double>::infinity());
  expect_near(-1e300);
  std::fill_n(z, kLanes, std::nan(""));
  tanh_in_place(z, kLanes);
  EXPECT_TRUE(std::isnan(z[0]));
}

}  // namespace
}  // namespace beamgyro::internal::batch_network_test
