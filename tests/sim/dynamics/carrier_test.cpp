// SPDX-License-Identifier: MIT
// The carrier model against its equations and their algebraic solution.
#include "sim/dynamics/carrier.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/dynamics/carrier_unit.h"

namespace beamgyro::internal::carrier_test {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2cd;
using Eigen::Vector2d;
using Eigen::VectorXd;

class CarrierEquations : public testing::TestWithParam<std::string> {
 protected:
  // Fast enough for every term of the motion to be seen.
  CaseMotion motion{900, -700, 1100, 2e7, 300};
  CarrierUnit unit{nominal_device({GetParam()}), 281.3, 290.2, motion};
  const LoopElectronics& loops = unit.ode.loops();
  Complex turn = electronics_at(unit.gyro, unit.T_board).turn;
  double t = 0.0123;
  VectorXd y = some_state(), dydt = slope();

  double w = loops.nominal_frequency, A = unit.reference();
  double theta = w * t + y(kCarrierPhase);
  Vector2d q = A * y.segment<2>(kPosition);
  Vector2d velocity = w * A * y.segment<2>(kVelocity);
  double a = std::hypot(y(kFeedback2), y(kFeedback2 + 1));
  double V_D = loops.nominal_voltage *
               (loops.agc_proportional * (1 - a) + y(kAgcIntegral));

  // Output of the loop around the readout, before the output filter.
  Complex signal() const {
    const Complex r2 = complex_at(y, kReadout2);
    if (!loops.rebalance) return r2;
    return -loops.rebalance_integral * complex_at(y, kRebalance) -
           loops.rebalance_proportional * r2;
  }

  // Slope of a pole at state `i`, as the input it must have had.
  Complex input_of_pole(Eigen::Index i, double corner) const {
    return complex_at(dydt, i) / corner + complex_at(y, i);
  }

 private:
  static VectorXd some_state() {
    VectorXd state(kCarrierStates);
    for (Eigen::Index i = 0; i < kCarrierStates; ++i)
      state(i) = 0.8 * std::sin(3.0 * static_cast<double>(i) + 1);
    return state;
  }
  VectorXd slope() const {
    VectorXd rate(kCarrierStates);
    unit.ode.rate(t, motion, y, rate);
    return rate;
  }
};

// (2.1): the force of patch p is |Theta_p V_p| at the phase of Theta_p V_p.
TEST_P(CarrierEquations, AccelerationHasEveryTerm) {
  ASSERT_LT(std::abs(V_D), loops.voltage_limit);
  const Complex V_B =
      loops.rebalance ? signal() * loops.voltage_axis / turn : Complex(0);
  const Vector2d force = ((unit.modal.coupling[kDrive] * V_D +
                           unit.modal.coupling[kDamping] * V_B) *
                          std::polar(1.0, theta))
                             .real();
  const double m = unit.modal.mass, m_g = unit.modal.coriolis_mass;
  const double Ox = motion.x, Oy = motion.y, Oz = motion.z;
  Matrix2d J2, centrifugal, in_phase;
  J2 << 0, -1, 1, 0;
  centrifugal << Oy * Oy + Oz * Oz, -Ox * Oy, -Ox * Oy, Ox * Ox + Oz * Oz;
  in_phase << 0, 1, 1, 0;
  const Matrix2d N = m_g * (motion.z_acceleration * J2 - centrifugal);
  const Matrix2d D = unit.modal.damping + 2 * m_g * Oz * J2 +
                     2 * m_g * motion.in_phase * in_phase;
  const Vector2d acceleration =
      (force - D * velocity - (unit.modal.stiffness + N) * q) / m;
  EXPECT_LT((A * dydt.segment<2>(kPosition) - velocity).norm(),
            1e-14 * velocity.norm());
  EXPECT_LT((w * A * dydt.segment<2>(kVelocity) - acceleration).norm(),
            1e-10 * acceleration.norm());
}

TEST_P(CarrierEquations, ElectronicsAreThoseOfTheLoops) {
  const double wf = loops.demodulator_corner, wo = loops.output_corner;
  const Complex reference = 2.0 * std::polar(1.0, -theta);
  const Vector2cd at_once = q.cast<Complex>();
  const Complex feedback = -reference *
                           charge_on(unit.modal, kFeedback, at_once) /
                           unit.gyro.loop.feedback_amplitude;
  EXPECT_LT(std::abs(input_of_pole(kFeedback1, wf) - std::conj(feedback)),
            1e-8);
  EXPECT_LT(std::abs(input_of_pole(kFeedback2, wf) - complex_at(y, kFeedback1)),
            1e-13);
  const double delta =
      std::atan2(y(kFeedback2), y(kFeedback2 + 1)) - loops.pll_phase;
  EXPECT_NEAR(dydt(kPllIntegral), loops.pll_integral * delta, 1e-9);
  EXPECT_NEAR(dydt(kAgcIntegral), loops.agc_integral * (1 - a), 1e-12);
  EXPECT_NEAR(dydt(kCarrierPhase),
              loops.pll_proportional * delta + y(kPllIntegral), 1e-9);

  const Complex charge = charge_on(unit.modal, kReadout, at_once) +
                         loops.feedthrough * V_D * std::cos(theta);
  const Complex r = reference * charge * turn / loops.charge_axis;
  EXPECT_LT(std::abs(input_of_pole(kReadout1, wf) - r), 1e-8 * std::abs(r));
  EXPECT_LT(std::abs(input_of_pole(kReadout2, wf) - complex_at(y, kReadout1)),
            1e-12);
  EXPECT_LT(std::abs(input_of_pole(kOutput1, wo) - signal()),
            1e-11 * std::abs(signal()));
  EXPECT_LT(std::abs(input_of_pole(kOutput2, wo) - complex_at(y, kOutput1)),
            1e-12);
  const Complex integrand = loops.rebalance ? complex_at(y, kReadout2) : 0;
  EXPECT_LT(std::abs(complex_at(dydt, kRebalance) - integrand), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Readout, CarrierEquations,
                         testing::Values("readout.mode=\"open_loop\"",
                                         "readout.mode=\"force_rebalance\""));

TEST(Verification, V19CarrierAtAFixedFrequencyIsTheAlgebraicSolution) {
  constexpr double kVoltage = 0.7, kOffset = -15;  // of V_0; [rad/s]
  CarrierUnit unit(nominal_device(), 285.0, 290.0, {0.4, -0.3, 2.0, 900, 0.01});
  const LoopElectronics& loops = unit.ode.loops();
  VectorXd start = unit.ode.at_rest();
  start(kFeedback2) = std::sin(loops.pll_phase);
  start(kFeedback2 + 1) = std::cos(loops.pll_phase);
  start(kPllIntegral) = kOffset;
  start(kAgcIntegral) = kVoltage;
  ExplicitRk rk = unit.from(start, [](Eigen::Ref<VectorXd> dydt) {
    dydt.segment<4>(kFeedback2).setZero();  // the loops are open
  });
  rk.advance_to(0.5);  // 19 decay times

  const double w = loops.nominal_frequency + kOffset;
  const double V_D = kVoltage * loops.nominal_voltage;
  const Vector2cd u =
      reference::solution(dynamic_stiffness(unit.modal, w, unit.motion),
                          unit.modal.coupling[kDrive] * V_D);
  for (const double t : {0.5, 0.50001, 0.50003}) {
    const VectorXd& y = rk.advance_to(t);
    for (const Eigen::Index i : {0, 1}) {
      const Complex now = u(i) * std::polar(1.0, w * t);
      EXPECT_NEAR(unit.reference() * y(kPosition + i), now.real(),
                  1e-6 * std::abs(u(i)));
    }
  }
  const Complex charge =
      charge_on(unit.modal, kReadout, u) + loops.feedthrough * V_D;
  const Complex r =
      charge * electronics_at(unit.gyro, unit.T_board).turn / loops.charge_axis;
  const Complex feedback =
      -charge_on(unit.modal, kFeedback, u) / unit.gyro.loop.feedback_amplitude;
  const VectorXd mean = mean_over_cycle(rk, w);
  EXPECT_LT(std::abs(complex_at(mean, kReadout2) - r), 1e-6 * std::abs(r));
  EXPECT_LT(std::abs(complex_at(mean, kFeedback1) - std::conj(feedback)),
            1e-6 * std::abs(feedback));
}

TEST(Verification, V29EulerForceShowsAsQuadratureOfTheCarrier) {
  CarrierUnit still(verification_device()), turning(verification_device());
  turning.motion.z_acceleration = 1000;  // [rad/s2]
  const double w = still.solution().drive_frequency;
  const auto quadrature = [&](CarrierUnit& unit) {
    ExplicitRk rk = unit.from(still.settled());
    rk.advance_to(0.25);
    return -mean_over_cycle(rk, w)(kOutput2 + 1);
  };
  EXPECT_NEAR(
      std::abs(quadrature(turning) - quadrature(still)) / (1000 / (2 * w)), 1,
      0.02);
}

TEST(Carrier, PhaseIsAsFineAfterADayOfWindowsAsAtFirst) {
  CarrierUnit unit(nominal_device());
  VectorXd y = unit.ode.at_rest(), dydt(kCarrierStates);
  y(kPosition) = 1;
  const auto demodulated = [&](double t) {
    unit.ode.rate(t, {}, y, dydt);
    return complex_at(dydt, kFeedback1);  // e^{i theta} times a constant
  };
  constexpr double kWindow = 1.0003;
  double jump = 0;
  for (int k = 0; k < 86400; ++k) {
    const Complex before = demodulated(kWindow);
    unit.ode.begin_window(kWindow);
    jump = std::max(jump, std::abs(demodulated(0) / before - 1.0));
  }
  EXPECT_LT(jump, 1e-10);
  const Complex start = demodulated(0);
  const double w = unit.ode.loops().nominal_frequency;
  for (const double t : {1e-5, 1e-4, 1e-3}) {
    const Complex turned = demodulated(t) / start;
    EXPECT_LT(std::abs(turned - std::polar(1.0, w * t)), 1e-10);
  }
}

}  // namespace
}  // namespace beamgyro::internal::carrier_test
