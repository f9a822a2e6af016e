// SPDX-License-Identifier: MIT
#include "compensation/models/bp_network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::bp_network_test {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::VectorXd;

// Central differences of f over every weight; one column per weight.
template <class F>
Eigen::MatrixXd central_differences(BpNetwork network, const F& f) {
  const double h = 1e-5;
  const VectorXd w = network.weights();
  Eigen::MatrixXd slopes;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const VectorXd step = h * VectorXd::Unit(w.size(), i);
    network.set_weights(w + step);
    const VectorXd up = f(network);
    network.set_weights(w - step);
    const VectorXd down = f(network);
    slopes.conservativeResize(up.size(), w.size());
    slopes.col(i) = (up - down) / (2.0 * h);
  }
  return slopes;
}

TEST(BpNetwork, ComputesEquationsTwoAndThree) {
  BpNetwork network({2, 2, 1});
  VectorXd w(9);
  w << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9;
  network.set_weights(w);
  ArrayXXd x(1, 2);
  x << 1.5, -2.5;
  const auto tansig = [](double n) {
    return 2.0 / (1.0 + std::exp(-2.0 * n)) - 1.0;
  };
  const double a1 = tansig(0.1 * 1.5 - 0.3 * 2.5 + 0.5);
  const double a2 = tansig(0.2 * 1.5 - 0.4 * 2.5 + 0.6);
  EXPECT_NEAR(network.predict(x)(0), 0.7 * a1 + 0.8 * a2 + 0.9, 1e-15);
}

const std::vector<std::vector<int>> kSizes = {
    {2, 1}, {1, 6, 1}, {3, 14, 1}, {2, 5, 4, 1}, {3, 4, 3, 2, 1}};

TEST(BpNetwork, JacobianMatchesCentralDifferences) {
  for (const std::vector<int>& sizes : kSizes) {
    const BpNetwork network = random_network(sizes, 7);
    const ArrayXXd x = wavy_inputs(9, sizes.front());
    Eigen::MatrixXd jacobian;
    const ArrayXd y = network.predict_with_jacobian(x, jacobian);
    EXPECT_TRUE((y == network.predict(x)).all());
    const Eigen::MatrixXd expected = central_differences(
        network,
        [&](const BpNetwork& n) { return n.predict(x).matrix().eval(); });
    EXPECT_LT((jacobian - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(BpNetwork, GradientMatchesCentralDifferences) {
  for (const std::vector<int>& sizes : kSizes) {
    const BpNetwork network = random_network(sizes, 8);
    const ArrayXXd x = wavy_inputs(11, sizes.front());
    const ArrayXd target = x.col(0).square() - 0.4;
    VectorXd gradient;
    network.predict_with_gradient(x, target, gradient);
    const Eigen::MatrixXd expected =
        central_differences(network, [&](const BpNetwork& n) {
          return VectorXd::Constant(
              1, 0.5 * (n.predict(x) - target).square().sum());
        });
    EXPECT_LT((gradient.transpose() - expected).norm(), 1e-7 * expected.norm());
  }
}

TEST(BpNetwork, SampleGivesTheSameBitsAloneAndInABlock) {
  const BpNetwork network = random_network({3, 14, 1}, 9);
  const ArrayXXd x = wavy_inputs(1003, 3);
  const ArrayXd together = network.predict(x);
  for (Eigen::Index k = 0; k < x.rows(); ++k)
    EXPECT_EQ(network.predict(x.middleRows(k, 1))(0), together(k)) << k;
}

TEST(BpNetwork, InitialWeightsDependOnTheSeedOnly) {
  EXPECT_EQ(random_network({2, 3, 1}, 1).weights(),
            random_network({2, 3, 1}, 1).weights());
  EXPECT_NE(random_network({2, 3, 1}, 1).weights(),
            random_network({2, 3, 1}, 2).weights());
}

TEST(BpNetwork, TransitionsOfTheInitialWeightsSpreadOverTheInputRange) {
  const BpNetwork network = random_network({1, 6, 1}, 3);
  const ArrayXd W = network.weights().segment(0, 6).array();
  const ArrayXd b = network.weights().segment(6, 6).array();
  EXPECT_LT((W.abs() - 0.7 * 6.0).abs().maxCoeff(), 1e-12);
  const ArrayXd centres = -b / W;
  for (Eigen::Index o = 0; o < 6; ++o)
    EXPECT_NEAR(centres(o), 1.0 - 0.4 * double(o), 1e-12);
}

TEST(BpNetwork, RejectsImpossibleSizes) {
  EXPECT_THROW(BpNetwork({3}), std::invalid_argument);
  EXPECT_THROW(BpNetwork({1, 0, 1}), std::invalid_argument);
  EXPECT_TRUE(holds(rejection([] { BpNetwork({1, 4, 2}); }), "2 outputs"));
  BpNetwork network({1, 6, 1});
  EXPECT_TRUE(holds(rejection([&] { network.set_weights(VectorXd::Zero(18)); }),
                    "18 weights, its layers need 19"));
}

}  // namespace
}  // namespace beamgyro::internal::bp_network_test
