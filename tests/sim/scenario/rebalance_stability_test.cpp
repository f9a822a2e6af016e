// SPDX-License-Identifier: MIT
// Force rebalance whose loop oscillates away from the temperature at which its
// gains are set.
#include <gtest/gtest.h>

#include <string>

#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::rebalance_stability_test {
namespace {

constexpr char kQuiet[] = "[noise]\nenabled = false\n";
constexpr char kStirred[] = "[chamber]\nstirred = true\n";

// Ceramic of a mechanical Q of 3,333, with which the loop is unstable below
// -63 degC.
DeviceParameters high_q() {
  return nominal_device({"readout.mode=\"force_rebalance\"",
                         "patches.mechanical_loss_factor=3e-4",
                         "thermal.electronics_power_W=0.0"});
}

std::string failure(const ScenarioPlan& scenario) {
  return rejection<SimulationFailure>(
      [&] { simulated(scenario, make_gyro(high_q())); });
}

TEST(RebalanceStability, EveryFidelityNamesTemperatureAndKey) {
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope, Fidelity::kCarrier}) {
    for (const char* noise : {kQuiet, ""}) {
      ScenarioPlan scenario =
          scenario_from(noise, "[ambient]\nconstant_degC = -70\n", "1.5", "10");
      scenario.fidelity = fidelity;
      const std::string text = failure(scenario);
      EXPECT_TRUE(holds(text, "readout.mode = \"force_rebalance\""));
      EXPECT_TRUE(holds(text, "beam at -70.00 degC"));
      EXPECT_TRUE(holds(text, "patches.mechanical_loss_factor"));
    }
  }
}

TEST(RebalanceStability, ARunThatCoolsEndsWhereTheLoopBecomesUnstable) {
  for (const char* noise : {kQuiet, ""}) {
    ScenarioPlan scenario = scenario_from(
        std::string(noise) + kStirred,
        "[ambient]\npoints = [[0, 25], [1200, -95]]\n", "2400", "1");
    scenario.fidelity = Fidelity::kEnvelope;
    EXPECT_TRUE(holds(failure(scenario), "unstable at "));
  }
}

TEST(RebalanceStability, StoresInTheColdWithoutPowerAreNoMatter) {
  const ScenarioPlan scenario = scenario_from(
      std::string(kQuiet) + "[power]\non_s = [5000]\n" + kStirred,
      "[ambient]\npoints = [[0, -70], [3000, 25]]\n", "6000", "0.1");
  EXPECT_NO_THROW(simulated(scenario, make_gyro(high_q())));
}

TEST(RebalanceStability, ASoftCeramicIsStableOverItsWholeRange) {
  ScenarioPlan scenario = scenario_from(
      kStirred, "[ambient]\npoints = [[0, 70], [3000, -80]]\n", "3000", "0.2");
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope}) {
    scenario.fidelity = fidelity;
    EXPECT_NO_THROW(simulated(
        scenario,
        make_gyro(nominal_device({"readout.mode=\"force_rebalance\""}))));
  }
}

}  // namespace
}  // namespace beamgyro::internal::rebalance_stability_test
