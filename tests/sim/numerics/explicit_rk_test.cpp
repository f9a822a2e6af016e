// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/numerics/ode.h"

namespace beamgyro::internal::explicit_rk_test {
namespace {

// A pendulum that turns over, with a drag that depends on time: nonlinear, not
// autonomous, smooth.
void pendulum(double t, const Eigen::Ref<const Eigen::VectorXd>& y,
              Eigen::Ref<Eigen::VectorXd> dydt) {
  dydt(0) = y(1);
  dydt(1) = -std::sin(y(0)) - 0.1 * std::cos(t) * y(1);
}

const Eigen::Vector2d kStart(1.0, 1.5);

Eigen::VectorXd end_of_pendulum(RkTable table, double step) {
  ExplicitRkOptions options;
  options.table = table;
  options.fixed_step = step;
  ExplicitRk rk(pendulum, 0, kStart, options);
  return rk.advance_to(4.0);
}

struct TableOrder {
  RkTable table;
  double order, step;
};

class OrderOf : public testing::TestWithParam<TableOrder> {};

TEST_P(OrderOf, V45FixedStepsConvergeAtTheNominalOrder) {
  const auto [table, order, step] = GetParam();
  const Eigen::VectorXd exact = end_of_pendulum(RkTable::kFehlberg, 1.0 / 128);
  const double coarse = (end_of_pendulum(table, step) - exact).norm();
  const double fine = (end_of_pendulum(table, step / 2) - exact).norm();
  EXPECT_GT(fine, 1e-13);  // above the roundoff
  EXPECT_NEAR(std::log2(coarse / fine), order, 0.3);
}

INSTANTIATE_TEST_SUITE_P(
    Verification, OrderOf,
    testing::Values(TableOrder{RkTable::kDormandPrince, 5, 1.0 / 16},
                    TableOrder{RkTable::kFehlberg, 8, 1.0 / 4}));

TEST(ExplicitRk, LandsOnItsStopsWithoutLosingDigits) {
  ExplicitRkOptions options;
  options.absolute_tolerance.setConstant(1e-12);
  ExplicitRk whole(pendulum, 0, kStart, options);
  ExplicitRk in_pieces(pendulum, 0, kStart, options);
  for (int k = 1; k < 1000; ++k) {
    in_pieces.advance_to(0.004 * k);
    EXPECT_EQ(in_pieces.time(), 0.004 * k);
  }
  EXPECT_LT((in_pieces.advance_to(4.0) - whole.advance_to(4.0)).norm(), 1e-11);
}

TEST(ExplicitRk, DoesNotLookBeyondTheStop) {
  double latest = 0;
  ExplicitRk rk(
      [&](double t, const auto&, auto dydt) {
        latest = std::max(latest, t);
        dydt.setOnes();
      },
      0, Eigen::VectorXd::Zero(1));
  rk.advance_to(1.5);
  EXPECT_LE(latest, 1.5);
}

TEST(ExplicitRk, RestartsFromAnotherStateAndGoesOnCounting) {
  ExplicitRk rk(pendulum, 0, kStart);
  rk.advance_to(1);
  const long steps = rk.steps();
  EXPECT_GT(steps, 0);
  const Eigen::Vector2d other(-0.4, 0.3);
  rk.restart(0.5, other);
  EXPECT_EQ(rk.steps(), steps);
  ExplicitRk fresh(pendulum, 0.5, other);
  EXPECT_LT((rk.advance_to(2) - fresh.advance_to(2)).norm(), 1e-7);
  EXPECT_GT(rk.steps(), steps);
}

TEST(ExplicitRk, CarriesExceptionsAndRefusesWhatIsNotFinite) {
  ExplicitRk throwing(
      [](double, const auto&, auto) { throw std::domain_error("no"); }, 0,
      kStart);
  EXPECT_THROW(throwing.advance_to(1), std::domain_error);
  ExplicitRk infinite(
      [](double, const auto&, auto dydt) {
        dydt.setConstant(std::numeric_limits<double>::infinity());
      },
      0, kStart);
  EXPECT_THROW(infinite.advance_to(1), std::runtime_error);
  ExplicitRkOptions options;
  options.absolute_tolerance = Eigen::Vector3d::Ones();
  EXPECT_THROW(ExplicitRk(pendulum, 0, kStart, options), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::explicit_rk_test
