// SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>

#include "sim/scenario/simulation.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::quasistatic_run_test {
namespace {

const std::vector<double>& values(const Recording& recording,
                                  const char* name) {
  return column_values(recording, name);
}

constexpr const char* kQuiet = "[noise]\nenabled = false\n";
// A unit that makes no heat stays at the temperature of its trims.
const std::vector<std::string> kCold = {"thermal.electronics_power_W=0.0"};

TEST(Verification, V47SameSeedGivesTheSameBitsInAnyThread) {
  const ScenarioPlan scenario = scenario_from(
      "[rate.random]\nrms_deg_per_s = 3\nbandwidth_Hz = 2\n"
      "[power]\non_s = [0, 60]\noff_s = [50]\n");
  const DeviceParameters device = nominal_device();
  const Recording alone = simulated(scenario, device);
  Recording first, second;
  std::thread a([&] { first = simulated(scenario, device); });
  std::thread b([&] { second = simulated(scenario, device); });
  a.join();
  b.join();
  EXPECT_TRUE(same_bits(alone, first));
  EXPECT_TRUE(same_bits(alone, second));
  EXPECT_FALSE(
      same_bits(alone, simulated(scenario, device, {.device = 1, .run = 0})));
}

TEST(QuasistaticRun, AtItsTrimTemperatureTheGyroShowsTrimPlusRate) {
  const ScenarioPlan scenario = scenario_from(
      std::string("[rate]\nsteps = [[0, 0], [50, 100]]\n") + kQuiet);
  const Recording run = simulated(scenario, nominal_device(kCold));
  const double lsb = 300.0 / 65536;  // [deg/s]
  EXPECT_NEAR(values(run, "rate")[100], 0.5, 0.51 * lsb);
  // The drive heats the beam by millikelvin; the scale factor nonlinearity is
  // 1.5e-5 at 100 deg/s.
  EXPECT_NEAR(values(run, "rate")[900], 100.5, 0.51 * lsb + 2e-3);
  EXPECT_NEAR(values(run, "output")[900], 2.5 + 0.0125 * 100.5,
              0.0125 * (0.51 * lsb + 2e-3));
  EXPECT_EQ(values(run, "true_rate")[499], 0);
  EXPECT_NEAR(values(run, "true_rate")[500], 100, 1e-12);
  EXPECT_NEAR(values(run, "quadrature")[100], 40, 0.011);
  EXPECT_NEAR(values(run, "drive_frequency")[100], 9081.50, 0.02);
  EXPECT_NEAR(values(run, "temperature")[100], 25.3, 1e-9);
}

TEST(QuasistaticRun, TrueBiasIsTheTwinAtRest) {
  const std::string ambient = "[ambient]\npoints = [[0, -20], [100, 30]]\n";
  const DeviceParameters device = nominal_device();
  const Recording turning = simulated(
      scenario_from("[rate]\nconstant_deg_per_s = 80\n", ambient), device);
  const Recording resting = simulated(scenario_from(kQuiet, ambient), device);
  const auto& twin = values(turning, "true_bias");
  const auto& rest = values(resting, "true_bias");
  double largest = 0;
  for (std::size_t k = 0; k < twin.size(); ++k)
    largest = std::max(largest, std::abs(twin[k] - rest[k]));
  EXPECT_LT(largest, 1e-5);  // two tables of the static map
}

TEST(QuasistaticRun, UnpoweredSamplesAreBlankAndFlagged) {
  const ScenarioPlan scenario =
      scenario_from("[power]\non_s = [10, 60]\noff_s = [40]\n");
  const Recording run = simulated(scenario, nominal_device());
  for (std::size_t k = 0; k < run.time.size(); ++k) {
    const double t = run.time[k];
    const bool powered = (t >= 10 && t < 40) || t >= 60;
    EXPECT_EQ((run.status[k] & kUnpowered) == 0, powered) << t;
    for (const Column& column : run.columns) {
      EXPECT_EQ(std::isnan(column.values[k]),
                !powered && column.role == Role::kMeasured)
          << column.name << " at " << t;
    }
  }
}

TEST(QuasistaticRun, EveryPowerCycleHasItsOwnTurnOnOffset) {
  const DeviceParameters device =
      nominal_device({"noise.turn_on_deg_per_s=5.0"});
  const Recording cycled = simulated(
      scenario_from("[power]\non_s = [0, 50]\noff_s = [40]\n"), device);
  const auto offset = [&](std::size_t k) {
    return values(cycled, "rate")[k] - values(cycled, "true_bias")[k];
  };
  EXPECT_GT(std::abs(offset(200) - offset(800)), 0.3);
  EXPECT_NEAR(offset(200), offset(300), 0.3);
}

TEST(QuasistaticRun, ARateBeyondFullScaleSaturatesAndSaysSo) {
  const Recording run =
      simulated(scenario_from("[rate]\npoints = [[0, 0], [100, 300]]\n"),
                nominal_device());
  const auto& rate = values(run, "rate");
  EXPECT_EQ(run.status[200], 0);
  EXPECT_EQ(run.status[800], kOutputSaturated);
  EXPECT_NEAR(rate[800], 150, 0.01);
  EXPECT_GT(values(run, "true_rate")[800], 200);
}

// What the random walk alone adds to the rate of a run [deg/s].
std::vector<double> walk_of(const std::string& age,
                            const std::string& duration) {
  const DeviceParameters device = nominal_device(
      {"noise.angle_random_walk_deg_per_sqrt_s=0.0",
       "noise.bias_instability_deg_per_s=0.0", "noise.turn_on_deg_per_s=0.0",
       "noise.rate_random_walk_deg_per_s_per_sqrt_s=0.1",
       "readout.amplifier_noise_V_per_sqrt_Hz=0.0"});
  const std::string ambient = "[ambient]\nconstant_degC = 25\n";
  std::vector<double> walk = values(
      simulated(scenario_from(age, ambient, duration, "1"), device), "rate");
  const Recording quiet =
      simulated(scenario_from(age + kQuiet, ambient, duration, "1"), device);
  for (std::size_t k = 0; k < walk.size(); ++k)
    walk[k] -= values(quiet, "rate")[k];
  return walk;
}

TEST(QuasistaticRun, TheRandomWalkGoesOnFromRunToRun) {
  const std::vector<double> whole = walk_of("[age]\nhours = 0\n", "3600");
  const std::vector<double> later = walk_of("[age]\nhours = 0.5\n", "1800");
  // Two roundings of the converter of 300 deg/s / 2^16, and the Brownian noise
  // of a second.
  constexpr double kRoundoff = 0.015;  // [deg/s]
  EXPECT_GT(std::abs(later.front()), 10 * kRoundoff);
  for (std::size_t k = 0; k < later.size(); ++k)
    ASSERT_NEAR(later[k], whole[1800 + k], kRoundoff) << k;
  // Without an age a run has a walk of its own, from 0.
  const std::vector<double> fresh = walk_of("", "1800");
  EXPECT_NEAR(fresh.front(), 0, kRoundoff);
  EXPECT_GT(std::abs(fresh.back() - whole[1799]), 10 * kRoundoff);
}

TEST(QuasistaticRun, ADriveAtItsVoltageLimitIsFlagged) {
  const Recording run = simulated(
      scenario_from(""), nominal_device({"drive.voltage_limit_V=0.5"}));
  EXPECT_TRUE(run.status[10] & kLoopNotLocked);
  EXPECT_NEAR(values(run, "drive_voltage")[10], 0.5, 1e-9);
}

TEST(QuasistaticRun, DoesNotDependOnHowItIsCutIntoBlocks) {
  const std::string ambient = "[ambient]\npoints = [[0, -20], [1500, 30]]\n";
  for (const char* motion :
       {"[rate]\nsine = { amplitude_deg_per_s = 20, frequency_Hz = 0.1 }\n",
        "[rate.random]\nrms_deg_per_s = 3\nbandwidth_Hz = 2\n[acceleration]\n"
        "x = { random = { rms_g = 1, bandwidth_Hz = 2 } }\n"}) {
    const ScenarioPlan scenario = scenario_from(motion, ambient, "2000", "10");
    const Recording whole = simulated(scenario, nominal_device());
    std::size_t first = 0, blocks = 0;
    simulate_quasistatic(
        scenario, make_gyro(nominal_device()), {},
        [&](Recording&& block) {
          ++blocks;
          ASSERT_EQ(block.columns.size(), whole.columns.size());
          for (std::size_t i = 0; i < block.columns.size(); ++i) {
            const auto& values = block.columns[i].values;
            ASSERT_LE(first + values.size(), whole.time.size());
            EXPECT_EQ(std::memcmp(values.data(),
                                  whole.columns[i].values.data() + first,
                                  values.size() * sizeof(double)),
                      0)
                << whole.columns[i].name << " from " << first;
          }
          first += block.time.size();
        },
        777);
    EXPECT_EQ(first, whole.time.size());
    EXPECT_EQ(blocks, 26);
  }
}

TEST(QuasistaticRun, RefusesAScenarioOfAnotherFidelity) {
  ScenarioPlan scenario = scenario_from("");
  const DeviceParameters device = nominal_device();
  for (const Fidelity other : {Fidelity::kEnvelope, Fidelity::kCarrier}) {
    scenario.fidelity = other;
    const std::string message = rejection([&] {
      simulate_quasistatic(scenario, make_gyro(device), {}, [](Recording&&) {});
    });
    EXPECT_TRUE(holds(message, "fidelity"));
    EXPECT_TRUE(holds(message, "quasistatic"));
  }
}

TEST(QuasistaticRun, WhiteNoiseHasTheDensityOfTheDeviceAtAnyOutputRate) {
  const DeviceParameters device =
      nominal_device({"noise.bias_instability_deg_per_s=0.0",
                      "noise.rate_random_walk_deg_per_s_per_sqrt_s=0.0",
                      "noise.turn_on_deg_per_s=0.0", "readout.adc_bits=30",
                      "thermal.electronics_power_W=0.0"});
  for (const char* rate : {"10", "200"}) {
    const Recording run = simulated(
        scenario_from("", "[ambient]\nconstant_degC = 25\n", "1000", rate),
        device);
    double sum = 0;
    const auto& shown = values(run, "rate");
    const auto& bias = values(run, "true_bias");
    for (std::size_t k = 0; k < shown.size(); ++k)
      sum += (shown[k] - bias[k]) * (shown[k] - bias[k]);
    const auto n = static_cast<double>(shown.size());
    const double variance = 0.01 * 0.01 * std::stod(rate);
    EXPECT_NEAR(sum / n / variance, 1, 3 * std::sqrt(2 / n)) << rate << " Hz";
  }
}

}  // namespace
}  // namespace beamgyro::internal::quasistatic_run_test
