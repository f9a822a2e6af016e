// SPDX-License-Identifier: MIT
// The scale factor error of a unit is what every fidelity shows of it.
#include <gtest/gtest.h>

#include <string>

#include "sim/dynamics/gyro.h"
#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::scale_factor_error_test {
namespace {

constexpr double kError = 0.04;
constexpr double kRate = 50;  // [deg/s]

DeviceParameters unit(const std::string& mode, double error) {
  return nominal_device(
      {"readout.mode=\"" + mode + "\"", "readout.adc_bits=32",
       "readout.scale_factor_error=" + std::to_string(error)});
}

// What the output shows of kRate at 25 degC, the output at rest taken off.
double shown(const DeviceParameters& device, Fidelity fidelity) {
  ScenarioPlan scenario = scenario_from(
      "[rate]\nconstant_deg_per_s = 50\n[noise]\nenabled = false\n",
      "[ambient]\nconstant_degC = 25\n", "0.4", "100");
  scenario.fidelity = fidelity;
  const Recording run = simulated(scenario, device);
  return column_values(run, "rate").back() -
         column_values(run, "true_bias").back();
}

class ScaleFactorError : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Modes, ScaleFactorError,
                         testing::Values("open_loop", "force_rebalance"));

TEST_P(ScaleFactorError, EveryFidelityShowsIt) {
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope, Fidelity::kCarrier}) {
    const double exact = shown(unit(GetParam(), 0), fidelity);
    const double wrong = shown(unit(GetParam(), kError), fidelity);
    // The loops of envelope and carrier have settled to 1e-3 by 0.4 s.
    EXPECT_NEAR(exact, kRate, 0.1);
    EXPECT_NEAR(wrong / exact, 1 + kError, 1e-4) << static_cast<int>(fidelity);
  }
}

TEST_P(ScaleFactorError, TrimsHoldWhateverItIs) {
  const TrimmedGyro exact = make_gyro(unit(GetParam(), 0));
  const TrimmedGyro wrong = make_gyro(unit(GetParam(), kError));
  EXPECT_EQ(exact.stiffness_trim, wrong.stiffness_trim);
  const auto at_rest = [](const TrimmedGyro& gyro) {
    return electronics_at(gyro, kCalibrationTemperature)
        .output(beam_signal(gyro, kCalibrationTemperature, {}).demodulated);
  };
  EXPECT_NEAR(at_rest(exact).rate, at_rest(wrong).rate, 1e-12);
  EXPECT_NEAR(at_rest(wrong).quadrature / at_rest(exact).quadrature, 1 + kError,
              1e-9);
  // Relative to T_0 the slope is that of any unit.
  const ModalParameters modal = modal_at(wrong, kCalibrationTemperature);
  EXPECT_NEAR(rate_slope(wrong, modal, kCalibrationTemperature), 1, 1e-6);
}

}  // namespace
}  // namespace beamgyro::internal::scale_factor_error_test
