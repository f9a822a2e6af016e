// SPDX-License-Identifier: MIT
// What a unit with memory shows in a run, in all fidelities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/memory/unit_memory.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::memory_test {
namespace {

constexpr char kQuiet[] = "[noise]\nenabled = false\n";

DeviceParameters lifelike() {
  Overrides none;
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/lifelike.toml", none);
  const DeviceParameters device = read_device(document);
  document.reject_unknown_keys();
  return device;
}

bool has_column(const Recording& run, const std::string& name) {
  return std::ranges::any_of(
      run.columns, [&](const Column& column) { return column.name == name; });
}

double farthest(const std::vector<double>& a, const std::vector<double>& b,
                std::size_t from = 0) {
  double farthest = 0;
  for (std::size_t k = from; k < a.size(); ++k)
    farthest = std::max(farthest, std::abs(a[k] - b[k]));
  return farthest;
}

// Up through the glass transition and back within an hour.
ScenarioPlan excursion(Fidelity fidelity, const std::string& more = "") {
  ScenarioPlan scenario =
      scenario_from(kQuiet + more,
                    "[ambient]\npoints = [[0, 25], [1200, 55], [1800, 55], "
                    "[3600, 5]]\n[chamber]\nstirred = true\n",
                    "3600", "1");
  scenario.fidelity = fidelity;
  return scenario;
}

TEST(V48Memory, EffectsOfNoStrengthChangeNothing) {
  const ScenarioPlan scenario = excursion(Fidelity::kQuasistatic);
  const Recording plain = simulated(scenario, nominal_device());
  EXPECT_FALSE(has_column(plain, "true_fictive_temperature"));
  EXPECT_FALSE(has_column(plain, "true_hysteresis"));
  // x = 1 takes T_f out of tau_alpha.
  const Recording still = simulated(
      scenario, nominal_device({"memory.relaxation.modulus_per_K=0",
                                "memory.relaxation.nonlinearity=1.0",
                                "memory.hysteresis.stiffness=0",
                                "memory.hysteresis.loss=0",
                                "memory.hysteresis.mount_axis_deg=0"}));
  // The tolerance of the static map of a unit with memory.
  EXPECT_LT(farthest(column_values(plain, "true_bias"),
                     column_values(still, "true_bias")),
            1e-5);
  EXPECT_TRUE(has_column(still, "true_fictive_temperature"));
}

// The bias of a run by the exact solution, with the memory taken through its
// temperatures sample by sample [deg/s]; not a number but at every `stride`-th
// sample.
std::vector<double> direct_bias(const Recording& run,
                                const DeviceParameters& device,
                                std::size_t stride) {
  const TrimmedGyro gyro = make_gyro(device);
  const auto at = [&](const char* name, std::size_t k) {
    return column_values(run, name)[k] + kZeroCelsius;
  };
  UnitMemory memory(device.memory, device.bond.glass_transition, {},
                    at("true_beam_temperature", 0));
  std::vector<double> bias(run.time.size(), NAN);
  for (std::size_t k = 0; k < bias.size(); ++k) {
    const double patches = at("true_pzt_temperature", k);
    const double beam = at("true_beam_temperature", k);
    if (k > 0)
      memory.advance_patches(at("true_pzt_temperature", k - 1), patches,
                             run.time[k] - run.time[k - 1]);
    memory.push_beam(beam);
    if (k % stride != 0) continue;
    const ModalParameters modal =
        modal_parameters(gyro.device, gyro.beam, beam, gyro.stiffness_trim,
                         memory.state(patches));
    bias[k] = electronics_at(gyro, at("true_board_temperature", k))
                  .output(beam_signal(gyro, modal, {}).demodulated)
                  .rate /
              kDegree;
  }
  return bias;
}

TEST(Memory, ARunIsThatOfSmallStepsAndTheExactSolution) {
  constexpr std::size_t kStride = 7;
  for (const DeviceParameters& device :
       {lifelike(), nominal_device({"memory.relaxation={}",
                                    "memory.hysteresis.mount_axis_deg=0.02",
                                    "memory.ageing.trim_age_hours=1.0"})}) {
    const Recording run = simulated(excursion(Fidelity::kQuasistatic), device);
    const std::vector<double> want = direct_bias(run, device, kStride);
    const std::vector<double>& have = column_values(run, "true_bias");
    for (std::size_t k = 0; k < have.size(); k += kStride)
      ASSERT_NEAR(have[k], want[k], 1e-5) << run.time[k];
  }
}

TEST(Memory, ABondThatNoTableResolvesIsSolvedExactly) {
  // From 25 to -55, 125 and 25 degC at 5 K/min.
  const auto bias = [](const std::string& more, const char* activation) {
    return column_values(
        simulated(scenario_from(kQuiet + more,
                                "[ambient]\npoints = [[0, 25], [960, -55], "
                                "[3120, 125], [4320, 25]]\n"
                                "[chamber]\nstirred = true\n",
                                "4320", "0.1"),
                  nominal_device(
                      {std::string("memory.relaxation.activation_J_per_mol=") +
                       activation})),
        "true_bias");
  };
  // A run with another axis than the input axis solves every sample exactly.
  const std::string exact = "[acceleration.x]\nconstant_g = 1e-12\n";
  for (const char* activation : {"1e5", "1.5e5", "6e5"})
    EXPECT_LT(farthest(bias("", activation), bias(exact, activation)), 1e-5)
        << activation;
}

TEST(Memory, ATableDoesNotFailForStatesThatTheRunNeverVisits) {
  // The bond freezes at -95 degC with T_f far above and far below T, and is so
  // soft in the one and so stiff in the other that no table over both locks.
  const DeviceParameters device =
      nominal_device({"memory.relaxation.activation_J_per_mol=2e4",
                      "memory.relaxation.modulus_per_K=-0.005"});
  const ScenarioPlan scenario =
      scenario_from(kQuiet,
                    "[ambient]\npoints = [[0, -95], [2820, 140]]\n"
                    "[chamber]\nstirred = true\n",
                    "2820", "0.1");
  EXPECT_NO_THROW(simulated(scenario, device));
}

TEST(Memory, AVisitedStateThatCannotLockIsNamedByTimeAndTemperature) {
  // Heated so fast that T_f stays behind and takes most of the bond's modulus.
  const DeviceParameters device =
      nominal_device({"memory.relaxation.activation_J_per_mol=1e4",
                      "memory.relaxation.modulus_per_K=-0.005"});
  const ScenarioPlan scenario =
      scenario_from(kQuiet,
                    "[ambient]\npoints = [[0, -95], [2820, 140]]\n"
                    "[chamber]\nstirred = true\n",
                    "2820", "0.05");
  const std::string text =
      rejection<SimulationFailure>([&] { simulated(scenario, device); });
  EXPECT_TRUE(holds(text, " s, with the beam at 9"));
  EXPECT_TRUE(holds(text, " degC: drive loop: no frequency near "));
}

TEST(Memory, EnvelopeAndQuasiStaticRunAgree) {
  const auto bias = [](Fidelity fidelity, const DeviceParameters& device) {
    return column_values(simulated(excursion(fidelity), device), "true_bias");
  };
  const auto distance = [&](const DeviceParameters& device) {
    constexpr std::size_t kLocked = 20;  // [s]
    return farthest(bias(Fidelity::kQuasistatic, device),
                    bias(Fidelity::kEnvelope, device), kLocked);
  };
  // The quasi-static run leaves out the lag of mode and loops, 27 ms times the
  // slope of the bias. Memory adds to the slope, and the tolerances of map and
  // table.
  EXPECT_LT(distance(lifelike()), 1.3 * distance(nominal_device()) + 2e-5);
}

TEST(Memory, CarrierAndEnvelopeAgree) {
  ScenarioPlan scenario = scenario_from(
      kQuiet, "[ambient]\npoints = [[0, 36], [10, 45]]\n", "0.8", "50");
  scenario.history = PiecewiseLinear({0, 1000}, {333.15, 309.15});
  const auto end = [&](Fidelity fidelity, const DeviceParameters& device) {
    scenario.fidelity = fidelity;
    return column_values(simulated(scenario, device), "true_bias").back();
  };
  const double effect = end(Fidelity::kEnvelope, lifelike()) -
                        end(Fidelity::kEnvelope, nominal_device());
  EXPECT_GT(std::abs(effect), 0.01);
  EXPECT_NEAR(end(Fidelity::kCarrier, lifelike()) -
                  end(Fidelity::kCarrier, nominal_device()),
              effect, 1e-4);
}

// The first fall from 50 to -40 degC against the rise after it, at 0.05 K/min
// [deg/s], by the temperature of the sensor: by then the bond's glass follows
// from the cycle and no more from what came before the run.
double widest_loop(const DeviceParameters& device) {
  const Recording run = simulated(
      scenario_from(kQuiet,
                    "[ambient.soaks]\ntemperatures_degC = [-40, 50, -40, 50]\n"
                    "hold_s = 3600\nramp_K_per_min = 0.05\n"
                    "[chamber]\nstirred = true\n",
                    "338400", "0.1"),
      device);
  const std::vector<double>& T = column_values(run, "true_sensor_temperature");
  const std::vector<double>& bias = column_values(run, "true_bias");
  const auto half = T.begin() + static_cast<std::ptrdiff_t>(T.size() / 2);
  const auto top = std::max_element(T.begin(), half);
  const auto bottom = std::min_element(top, T.end());
  double widest = 0;
  auto up = bottom;
  for (auto down = bottom; down > top; --down) {
    if (*down < -35 || *down > 48) continue;
    while (*up < *down) ++up;
    const auto k = up - T.begin();
    const double share = (*down - *(up - 1)) / (*up - *(up - 1));
    widest = std::max(
        widest, std::abs(bias[static_cast<std::size_t>(down - T.begin())] -
                         std::lerp(bias[static_cast<std::size_t>(k - 1)],
                                   bias[static_cast<std::size_t>(k)], share)));
  }
  return widest;
}

TEST(Memory, LifelikeUnitHasALoopBetweenHeatingAndCooling) {
  // 0.214 by an independent model.
  EXPECT_NEAR(widest_loop(lifelike()), 0.214, 0.002);
  EXPECT_NEAR(widest_loop(nominal_device()), 0.053, 0.002);  // of the lag
}

// By an independent model ageing makes 0.48 deg/s, the glass, which relaxes
// from 34.8 to 25.3 degC, another 0.10.
TEST(Memory, AYearMovesTheBiasByTenthsOfADegreePerSecond) {
  const auto bias = [](const std::string& more) {
    return column_values(simulated(scenario_from(kQuiet + more), lifelike()),
                         "true_bias")
        .back();
  };
  const double drift =
      std::abs(bias("[age]\nhours = 8766\n") - bias("[age]\nhours = 0\n"));
  EXPECT_NEAR(drift, 0.58, 0.02);
}

TEST(Memory, AHistoryOfTheScenarioShapesTheGlass) {
  const auto fictive = [](const std::string& more) {
    const ScenarioPlan scenario =
        scenario_from(kQuiet + more, "[ambient]\nconstant_degC = 5\n");
    return column_values(simulated(scenario, lifelike()),
                         "true_fictive_temperature")
        .front();
  };
  // Cooled at 1 and at 20 K/min, as in V49 and with its tolerance.
  EXPECT_NEAR(fictive(""), 34.206, 0.01);
  EXPECT_NEAR(fictive("[history]\npoints = [[0, 65], [180, 5]]\n"), 38.143,
              0.01);
}

TEST(Memory, DoesNotDependOnTheOutputRate) {
  ScenarioPlan fine = excursion(Fidelity::kQuasistatic), coarse = fine;
  coarse.output_rate = 0.01;
  const std::vector<double> a =
      column_values(simulated(fine, lifelike()), "true_bias");
  const std::vector<double> b =
      column_values(simulated(coarse, lifelike()), "true_bias");
  for (std::size_t k = 0; k < b.size(); ++k)
    EXPECT_NEAR(a[100 * k], b[k], 2e-5) << k;
}

}  // namespace
}  // namespace beamgyro::internal::memory_test
