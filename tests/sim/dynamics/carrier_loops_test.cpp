// SPDX-License-Identifier: MIT
// The loops of the carrier model: their fixed point with its ripple, start-up
// and small steps against linear models.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/dynamics/carrier_unit.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::carrier_loops_test {
namespace {

using Eigen::Vector2cd;
using Eigen::VectorXd;

constexpr double kTwoPi = 2 * std::numbers::pi;

// Re[g e^{2 i theta}] is the ripple of 1 - a, and of the phase error with -i g
// in place of g: what two poles w_f leave of the sum frequency.
Complex ripple(const CarrierUnit& unit, double w, double feedback_phase) {
  const LoopElectronics& loops = unit.ode.loops();
  const Complex pole = 1.0 + Complex(0, 2 * w / loops.demodulator_corner);
  return std::polar(1.0, 2 * (loops.pll_phase - feedback_phase)) /
         (pole * pole);
}

// phi_p of the coupling Theta_p = theta_p e^{i phi_p} along its axis.
double coupling_phase(const CarrierUnit& unit, Patch patch, Eigen::Index axis) {
  const Complex coupling = unit.modal.coupling[patch](axis);
  return std::arg(coupling * coupling) / 2;
}

// The static solution with what the ripple of V_D and of theta' = w + K_p delta
// at twice the carrier brings back to the carrier, to first order: a signal
// S e^{i theta} gains -i k conj(S)/2, where k is the ripple of theta.
Complex output_with_ripple(const CarrierUnit& unit) {
  const Complex i(0, 1);
  const LoopElectronics& loops = unit.ode.loops();
  const double w = unit.solution().drive_frequency;
  const double V = unit.solution().drive_voltage;
  const double phi_F = coupling_phase(unit, kFeedback, 0);
  const double phi_D = coupling_phase(unit, kDrive, 0);
  const Complex g = ripple(unit, w, phi_F);
  const Complex k = -loops.pll_proportional / (2 * w) * g;
  const Complex of_voltage =  // V cos(theta) gains Re[this e^{i theta}]
      0.5 * loops.agc_proportional * loops.nominal_voltage * g -
      0.5 * i * k * V;

  // What locks is U - i k conj(U)/2 with U = -i e^{i phi_pll}.
  const Complex gain =
      1.0 + 0.5 * i * k * std::polar(1.0, 2 * (phi_F - loops.pll_phase));
  const double tilt = std::arg(V + of_voltage * std::polar(1.0, -2 * phi_D));
  DriveLoop loop = unit.gyro.loop;
  loop.pll_phase -= std::arg(gain) + tilt;
  loop.feedback_amplitude /= std::abs(gain);
  const StaticSolution s = static_solution(unit.modal, loop, 0, unit.motion);
  const double mean =
      s.drive_voltage - (of_voltage * std::polar(1.0, -2 * phi_D)).real();
  const Vector2cd u = s.amplitude * std::polar(1.0, tilt);
  const Complex charge =
      charge_on(unit.modal, kReadout, u) -
      0.5 * i * k * charge_on(unit.modal, kReadout, u.conjugate()) +
      loops.feedthrough * (mean + of_voltage - 0.5 * i * k * mean);
  return charge * electronics_at(unit.gyro, unit.T_board).turn /
         loops.charge_axis;
}

const CaseMotion kEveryMotion{3, -2, 100 * kDegree, 0, 0.01};

// The state the carrier comes to, off from which it starts by 2e-4.
VectorXd rest(CarrierUnit& unit) {
  VectorXd start = unit.settled();
  start.head(4) *= 1.0002;
  ExplicitRk rk = unit.from(start);
  rk.advance_to(0.65);
  return mean_over_cycle(rk, unit.solution().drive_frequency);
}

class CarrierAtRest : public testing::TestWithParam<double> {};

TEST_P(CarrierAtRest, IsTheStaticSolutionAndTheRippleOfTheLoops) {
  const double T = GetParam();
  CarrierUnit unit(nominal_device(), T, T, kEveryMotion);
  const Complex found = complex_at(rest(unit), kOutput2);
  const Complex exact =
      beam_signal(unit.gyro, unit.modal, unit.motion).demodulated *
      electronics_at(unit.gyro, T).turn;
  EXPECT_NEAR(found.real() / kDegree, exact.real() / kDegree, 1e-4);
  const Complex expected = output_with_ripple(unit);
  EXPECT_LT(std::abs(found - expected) / kDegree, 5e-6);
  EXPECT_GT(std::abs(found - exact), 4 * std::abs(found - expected));
}

TEST_P(CarrierAtRest, IsTheStaticSolutionWithForceRebalance) {
  const double T = GetParam();
  CarrierUnit unit(nominal_device({"readout.mode=\"force_rebalance\""}), T, T,
                   kEveryMotion);
  const Complex found = complex_at(rest(unit), kOutput2);
  const Complex exact =
      beam_signal(unit.gyro, unit.modal, unit.motion).demodulated *
      electronics_at(unit.gyro, T).turn;
  EXPECT_NEAR(found.real() / kDegree, exact.real() / kDegree, 1e-4);
}

// 240 K is beside the crossing, 320 K at it.
TEST_P(CarrierAtRest, IsTheStaticSolutionWithASpuriousMode) {
  const double T = GetParam();
  CarrierUnit unit(
      nominal_device({"spurious_mode.wire={detuning=5.5e-3, "
                      "detuning_tc_per_K=-2.5e-4, loss_factor=1e-3, "
                      "coupling_drive=1e-4, coupling_sense=-5e-5}"}),
      T, T, kEveryMotion);
  const Complex found = complex_at(rest(unit), kOutput2);
  const Complex exact =
      beam_signal(unit.gyro, unit.modal, unit.motion).demodulated *
      electronics_at(unit.gyro, T).turn;
  EXPECT_NEAR(found.real() / kDegree, exact.real() / kDegree, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Temperatures, CarrierAtRest,
                         testing::Values(240.0, 320.0));

TEST(Carrier, DemodulatedFeedbackRipplesAtTwiceTheCarrier) {
  CarrierUnit unit(nominal_device());
  const double w = unit.solution().drive_frequency;
  ExplicitRk rk = unit.from(unit.settled());
  rk.advance_to(0.05);
  double least = 2, most = 0;
  for (int k = 0; k < 100; ++k) {
    const double q2 =
        rk.advance_to(0.05 + k * 0.01 * kTwoPi / w)(kFeedback2 + 1);
    least = std::min(least, q2), most = std::max(most, q2);
  }
  // Two poles w_f pass 1 / (1 + (2 w / w_f)^2) of it.
  const double ratio = 2 * w / unit.ode.loops().demodulator_corner;
  EXPECT_NEAR((most - least) / 2 * (1 + ratio * ratio), 1, 0.01);
}

TEST(Carrier, AmplitudeOfTheStartUp) {
  CarrierUnit unit(verification_device());
  ExplicitRk rk = unit.from(unit.ode.at_rest());
  const auto amplitude = [&](double t) {
    const VectorXd& y = rk.advance_to(t);
    return std::hypot(y(kPosition), y(kVelocity));
  };
  EXPECT_NEAR(amplitude(0.01), 0.71, 0.01);
  EXPECT_NEAR(amplitude(0.1), 0.97, 0.01);
  EXPECT_NEAR(amplitude(0.3), 0.999, 0.001);
}

constexpr int kSamples = 1500;

// `rest` plus the difference of two carriers per step: the ripple they share is
// gone.
StepResponse answer(CarrierUnit& unit, const VectorXd& stepped,
                    CarrierUnit& twin, const VectorXd& unstepped,
                    const std::function<double(const VectorXd&)>& signal,
                    double step, double rest) {
  ExplicitRk a = unit.from(stepped), b = twin.from(unstepped);
  return judged(kSamples, [&](double t) {
    return rest + (signal(a.advance_to(t)) - signal(b.advance_to(t))) / step;
  });
}

TEST(Verification, V32PhaseLoopOfTheCarrierAnswersAStepAsItsLinearModel) {
  constexpr double kStep = 1e-3;  // [rad]
  CarrierUnit before(verification_device());
  CarrierUnit after(verification_device({"drive.pll_phase_rad=0.011"}));
  const LoopElectronics& loops = after.ode.loops();
  const VectorXd unstepped = before.settled();
  VectorXd stepped = unstepped;
  stepped(kPllIntegral) +=
      before.ode.loops().nominal_frequency - loops.nominal_frequency;
  const StepResponse found = answer(
      after, stepped, before, unstepped,
      [](const VectorXd& y) {
        return std::atan2(y(kFeedback2), y(kFeedback2 + 1));
      },
      kStep, 0);
  expect_linear_loop(kSamples, found, loops.pll_proportional,
                     loops.pll_integral, 1, decay_time(after.modal),
                     loops.demodulator_corner);
}

TEST(Verification, V32AmplitudeLoopOfTheCarrierAnswersAStepAsItsLinearModel) {
  constexpr double kStep = 1e-3;
  CarrierUnit unit(verification_device()), twin(verification_device());
  const LoopElectronics& loops = unit.ode.loops();
  const VectorXd unstepped = unit.settled();
  VectorXd stepped = unstepped;
  stepped.head(8) *= 1 - kStep;  // vibration and demodulated feedback
  stepped(kAgcIntegral) *= 1 - kStep;
  const StepResponse found = answer(
      unit, stepped, twin, unstepped,
      [](const VectorXd& y) {
        return std::hypot(y(kFeedback2), y(kFeedback2 + 1));
      },
      kStep, 1);
  const double tau = decay_time(unit.modal);
  expect_linear_loop(kSamples, found, loops.agc_proportional,
                     loops.agc_integral, 1 / tau, tau,
                     loops.demodulator_corner);
}

}  // namespace
}  // namespace beamgyro::internal::carrier_loops_test
