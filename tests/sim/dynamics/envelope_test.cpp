// SPDX-License-Identifier: MIT
#include "sim/dynamics/envelope.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "sim/dynamics/loop_noise.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::envelope_test {
namespace {

const std::string kRebalanceMode = "readout.mode=\"force_rebalance\"";
// Two modes that cross near the temperatures of the tests, one of them with the
// housing.
const std::string kSpuriousModes =
    "spurious_mode={wire={detuning=-4.7e-3, detuning_tc_per_K=-2.5e-4, "
    "loss_factor=1e-3, coupling_drive=1e-4, coupling_sense=8e-5}, "
    "pin={detuning=-5e-3, detuning_tc_per_K=-3e-4, loss_factor=2e-3, "
    "coupling_drive=5e-5, coupling_sense=-2e-4, follows=\"housing\"}}";

EnvelopeInputs turning(double rate) {
  return {.motion = {0.4, -0.3, rate, 0, 0.01},
          .surroundings = {.ambient = 298.15},
          .powered = true};
}

Eigen::VectorXd settled(const TrimmedGyro& gyro, const EnvelopeOde& ode,
                        const CaseMotion& motion, double T) {
  return settled_state(gyro, ode, motion, T, T);
}

class Envelope : public testing::TestWithParam<std::vector<std::string>> {
 protected:
  TrimmedGyro gyro = make_gyro(nominal_device(GetParam()));
  EnvelopeOde ode{gyro, drive_heating(gyro)};

  // In open loop the integral of the rebalance is no part of the loops.
  Eigen::Index loops_and_readout() const {
    return ode.loops().rebalance ? kEnvelopeNodes : kRebalance;
  }
};

// With the drive at its limit in the glass transition of the bond, too.
TEST_P(Envelope, JacobianAgreesWithDifferences) {
  for (const double T : {281.3, 368.2}) {
    const EnvelopeInputs inputs = turning(2.0);
    Eigen::VectorXd y = settled(gyro, ode, inputs.motion, T);
    // Off the settled state, so that no slope is zero by accident.
    for (Eigen::Index i = 0; i < y.size(); ++i)
      if (i < kEnvelopeNodes || i >= ode.first_spurious())
        y(i) += 0.02 * std::sin(3.0 * static_cast<double>(i) + 1);
    y(kEnvelopeNodes + 0) = T + 1.77;
    y(kEnvelopeNodes + 4) = 290.2;
    const Eigen::Index n = ode.size();
    Eigen::MatrixXd J(n, n);
    ode.jacobian(inputs, y, J);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double h = 1e-4 * std::max(1.0, 0.02 * std::abs(y(j)));
      Eigen::VectorXd up(n), down(n), up2(n), down2(n);
      const auto at = [&](double step, Eigen::VectorXd& dydt) {
        Eigen::VectorXd moved = y;
        moved(j) += step;
        ode.rate(inputs, moved, dydt);
      };
      at(h, up), at(-h, down), at(2 * h, up2), at(-2 * h, down2);
      const Eigen::VectorXd slope =
          (8 * (up - down) - (up2 - down2)) / (12 * h);
      const double scale = slope.cwiseAbs().maxCoeff();
      EXPECT_LE((J.col(j) - slope).cwiseAbs().maxCoeff(), 1e-6 * scale)
          << "column " << j << " at " << T;
    }
  }
}

TEST_P(Envelope, V20FixedPointIsTheAlgebraicSolution) {
  for (const double T : {240.0, 298.15, 320.0, 368.15}) {
    for (const double rate : {0.0, 1.0}) {
      const EnvelopeInputs inputs = turning(rate);
      const Eigen::VectorXd y = settled(gyro, ode, inputs.motion, T);
      Eigen::VectorXd dydt(y.size());
      Eigen::MatrixXd J(y.size(), y.size());
      ode.rate(inputs, y, dydt);
      ode.jacobian(inputs, y, J);
      const Eigen::Index n = loops_and_readout();
      const Eigen::VectorXd distance =
          reference::solution(J.topLeftCorner(n, n), dydt.head(n));
      EXPECT_LT(distance.head(kPllIntegral).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT(distance.tail(n - kReadout1).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Readout, Envelope,
    testing::Values(std::vector<std::string>{}, std::vector{kRebalanceMode},
                    std::vector{kSpuriousModes},
                    std::vector{kSpuriousModes, kRebalanceMode}));

}  // namespace
}  // namespace beamgyro::internal::envelope_test
