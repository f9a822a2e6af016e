// SPDX-License-Identifier: MIT
// The loops and the envelope over time, against linear models and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "sim/dynamics/carrier.h"
#include "sim/dynamics/loop_noise.h"
#include "sim/numerics/ode.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::loops_test {
namespace {

using Eigen::VectorXd;

constexpr double kT0 = kCalibrationTemperature;
constexpr double kTwoPi = 2 * std::numbers::pi;

// The envelope of one unit at T_0, its temperatures held.
class HeldEnvelope {
 public:
  explicit HeldEnvelope(const DeviceParameters& device,
                        double tolerance = 1e-11)
      : gyro(make_gyro(device)), ode_(gyro, {0, 0}), tolerance_(tolerance) {}

  ExplicitRk from(const VectorXd& start) {
    ExplicitRkOptions options;
    options.table = RkTable::kDormandPrince;
    options.absolute_tolerance.setConstant(tolerance_);
    return ExplicitRk(
        [this](double t, const auto& y, auto dydt) { slope(t, y, dydt); }, 0,
        start, options);
  }
  VectorXd settled() { return settled_state(gyro, ode_, {}, kT0, kT0); }
  VectorXd at_rest() { return ode_.at_rest(kT0); }

  // Demodulated rate in front of the poles w_f, from the first pole's slope.
  double demodulated(double t, const VectorXd& y) {
    VectorXd dydt(y.size());
    slope(t, y, dydt);
    return y(kReadout1) + dydt(kReadout1) / ode_.loops().demodulator_corner;
  }
  const LoopElectronics& loops() const { return ode_.loops(); }

  TrimmedGyro gyro;
  std::function<double(double)> rate = [](double) { return 0.0; };

 private:
  void slope(double t, const Eigen::Ref<const VectorXd>& y,
             Eigen::Ref<VectorXd> dydt) {
    EnvelopeInputs inputs{
        .motion = {}, .surroundings = {.ambient = kT0}, .powered = true};
    inputs.motion.z = rate(t);
    ode_.rate(inputs, y, dydt);
    dydt.tail(dydt.size() - kEnvelopeNodes).setZero();
  }

  EnvelopeOde ode_;
  double tolerance_;
};

// Gain of the demodulated rate at one frequency of the true one.
double gain_at(HeldEnvelope& envelope, double frequency) {
  const double w = kTwoPi * frequency, amplitude = kDegree;
  envelope.rate = [=](double t) { return amplitude * std::sin(w * t); };
  ExplicitRk rk = envelope.from(envelope.settled());
  const double start = 0.5;  // 19 decay times
  const int cycles = std::max(2, static_cast<int>(0.3 * frequency));
  constexpr int kPerCycle = 40;
  std::complex<double> sum = 0;
  for (int k = 0; k < cycles * kPerCycle; ++k) {
    const double t = start + k / (kPerCycle * frequency);
    sum += envelope.demodulated(t, rk.advance_to(t)) * std::polar(1.0, -w * t);
  }
  return std::abs(sum) * 2 / (cycles * kPerCycle * amplitude);
}

TEST(Verification, V27SineRateSweepOfASplitUnit) {
  HeldEnvelope envelope(verification_device());
  const std::vector<std::pair<double, double>> expected = {
      {5, 1.0049}, {20, 1.0846}, {40, 1.450}, {70.7, 5.993}, {110, 0.7135}};
  for (const auto& [frequency, gain] : expected)
    EXPECT_NEAR(gain_at(envelope, frequency) / gain, 1, 0.01) << frequency;
}

TEST(Verification, V28BandwidthOfMatchedModes) {
  HeldEnvelope envelope(
      verification_device({"beam.side_difference=-8.0727e-5"}));
  const ModalParameters modal = modal_at(envelope.gyro, kT0);
  const double bandwidth = modal.damping(1, 1) / (2 * modal.mass) / kTwoPi;
  EXPECT_NEAR(bandwidth / 5.98, 1, 0.01);
  EXPECT_GT(gain_at(envelope, 0.99 * bandwidth), std::sqrt(0.5));
  EXPECT_LT(gain_at(envelope, 1.01 * bandwidth), std::sqrt(0.5));
}

const std::vector<std::string> kIdealRebalance = {
    "readout.mode=\"force_rebalance\"", "readout.feedthrough_F=0",
    "readout.phase_tc_rad_per_K=0", "readout.phase_tc2_rad_per_K2=0"};

TEST(Verification, V31RebalanceHoldsTheReadoutAtZeroWithItsScaleFactor) {
  HeldEnvelope envelope(verification_device(kIdealRebalance));
  envelope.rate = [](double) { return 50 * kDegree; };
  const VectorXd y = envelope.from(envelope.settled()).advance_to(1.5);
  EXPECT_LT(std::hypot(y(kReadout2), y(kReadout2 + 1)), 1e-9);

  const TrimmedGyro& gyro = envelope.gyro;
  const ModalParameters modal = modal_at(gyro, kT0);
  const StaticSolution s = static_solution(modal, gyro.loop, 0, {});
  const double scale = 2 * modal.coriolis_mass * s.drive_frequency *
                       std::abs(s.amplitude(0)) /
                       std::abs(modal.coupling[kDamping](1));
  EXPECT_NEAR(std::abs(gyro.rate_axis) / scale, 1, 1e-4);
}

TEST(Verification, V31BiasOfRebalanceDoesNotDependOnTheSplit) {
  const TrimmedGyro gyro = make_gyro(verification_device(kIdealRebalance));
  ModalParameters modal = modal_at(gyro, kT0);
  const double before = beam_signal(gyro, modal, {}).demodulated.real();
  modal.stiffness(1, 1) *= 1.005;
  const double after = beam_signal(gyro, modal, {}).demodulated.real();
  EXPECT_NEAR(after / kDegree, before / kDegree, 1e-6);
}

constexpr int kSamples = 4000;

TEST(Verification, V32PhaseLoopAnswersAStepAsItsLinearModel) {
  constexpr double kStep = 1e-3;  // [rad]
  HeldEnvelope before(verification_device());
  HeldEnvelope after(verification_device({"drive.pll_phase_rad=0.011"}));
  const LoopElectronics& loops = after.loops();
  VectorXd start = before.settled();
  start(kPllIntegral) +=
      before.loops().nominal_frequency - loops.nominal_frequency;
  ExplicitRk rk = after.from(start);
  const StepResponse found = judged(kSamples, [&](double t) {
    const VectorXd& y = rk.advance_to(t);
    return 1 + drive_signals(loops, y(kFeedback2), y(kFeedback2 + 1),
                             y(kPllIntegral), y(kAgcIntegral))
                       .phase_error() /
                   kStep;
  });
  const double tau = decay_time(modal_at(after.gyro, kT0));
  expect_linear_loop(kSamples, found, loops.pll_proportional,
                     loops.pll_integral, 1, tau, loops.demodulator_corner);
}

TEST(Verification, V32AmplitudeLoopAnswersAStepAsItsLinearModel) {
  constexpr double kStep = 1e-3;
  HeldEnvelope envelope(verification_device());
  const LoopElectronics& loops = envelope.loops();
  VectorXd start = envelope.settled();
  start.segment(kAmplitude, 4) *= 1 - kStep;
  start.segment(kFeedback1, 4) *= 1 - kStep;
  start(kAgcIntegral) *= 1 - kStep;
  ExplicitRk rk = envelope.from(start);
  const StepResponse found = judged(kSamples, [&](double t) {
    const VectorXd& y = rk.advance_to(t);
    return 1 - (1 - std::hypot(y(kFeedback2), y(kFeedback2 + 1))) / kStep;
  });
  const ModalParameters modal = modal_at(envelope.gyro, kT0);
  const double tau = 2 * modal.mass / modal.damping(0, 0);
  expect_linear_loop(kSamples, found, loops.agc_proportional,
                     loops.agc_integral, 1 / tau, tau,
                     loops.demodulator_corner);
}

TEST(StartUp, AmplitudeGrowsAsItsLoopsMakeIt) {
  HeldEnvelope envelope(verification_device());
  ExplicitRk rk = envelope.from(envelope.at_rest());
  const auto amplitude = [&](double t) {
    const VectorXd& y = rk.advance_to(t);
    return std::hypot(y(kAmplitude), y(kAmplitude + 1));
  };
  EXPECT_NEAR(amplitude(0.01), 0.71, 0.01);
  EXPECT_NEAR(amplitude(0.1), 0.97, 0.01);
  EXPECT_NEAR(amplitude(0.3), 0.999, 0.001);
}

TEST(Verification, V46ErrorsShrinkWithTheTolerance) {
  const auto envelope_end = [](double tolerance) {
    HeldEnvelope envelope(verification_device(), tolerance);
    return envelope.from(envelope.at_rest()).advance_to(0.1)(kOutput2);
  };
  const auto carrier_end = [](double tolerance) {
    CarrierOde ode(make_gyro(verification_device()));
    ExplicitRkOptions options;
    options.absolute_tolerance.setConstant(tolerance);
    ExplicitRk rk(
        [&](double t, const auto& y, auto dydt) { ode.rate(t, {}, y, dydt); },
        0, ode.at_rest(), options);
    return rk.advance_to(0.03)(kOutput2);
  };
  for (const auto& end :
       std::vector<std::function<double(double)>>{envelope_end, carrier_end}) {
    const double exact = end(1e-13);
    const double coarse = std::abs(end(1e-6) - exact);
    const double middle = std::abs(end(1e-8) - exact);
    const double fine = std::abs(end(1e-10) - exact);
    EXPECT_LT(middle, 0.1 * coarse);
    EXPECT_LT(fine, 0.1 * middle);
    EXPECT_LT(fine / kDegree, 1e-4);
  }
}

}  // namespace
}  // namespace beamgyro::internal::loops_test
