// SPDX-License-Identifier: MIT
// Runs in which the drive loop does not lock, loses its lock or has no power:
// what the fidelities say there is the same.
#include <gtest/gtest.h>

#include <string>

#include "sim/dynamics/gyro.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::loss_of_lock_test {
namespace {

Recording run_at(ScenarioPlan scenario, Fidelity fidelity,
                 const DeviceParameters& device) {
  scenario.fidelity = fidelity;
  scenario.noise_enabled = false;
  return internal::simulated(scenario, device);
}

std::string ambient(const std::string& profile) {
  return "[ambient]\n" + profile + "\n";
}

BeamSignal static_signal(const TrimmedGyro& gyro, const Recording& run,
                         std::size_t k) {
  return beam_signal(
      gyro, column_values(run, "true_beam_temperature")[k] + kZeroCelsius, {});
}

bool shows(const Recording& run, std::size_t k, StatusBit bit) {
  return (run.status[k] & bit) != 0;
}

// Time of the last sample that is not locked [s].
double last_unlocked(const Recording& run) {
  double last = -1;
  for (std::size_t k = 0; k < run.time.size(); ++k)
    if (shows(run, k, kLoopNotLocked)) last = run.time[k];
  return last;
}

// The bond's glass transition takes the drive beyond its voltage limit from 82
// to 117 degC.
TEST(Verification, V56EnvelopeLocksAgainAfterAHotExcursion) {
  const DeviceParameters device = nominal_device({"readout.adc_bits=32"});
  const TrimmedGyro gyro = make_gyro(device);
  const Recording run = run_at(
      scenario_from(
          "[chamber]\nstirred = true\n",
          ambient("points = [[0, 70], [300, 70], [600, 100], [1500, 100], "
                  "[1800, 25]]"),
          "3000", "2"),
      Fidelity::kEnvelope, device);
  double last_limited = -1;
  for (std::size_t k = 0; k < run.time.size(); ++k)
    if (!static_signal(gyro, run, k).amplitude_locked)
      last_limited = run.time[k];
  EXPECT_GT(last_limited, 1500);
  EXPECT_NEAR(last_unlocked(run), last_limited, 5);

  const std::size_t last = run.time.size() - 1;
  const double board =
      column_values(run, "true_board_temperature")[last] + kZeroCelsius;
  const double bias = electronics_at(gyro, board)
                          .output(static_signal(gyro, run, last).demodulated)
                          .rate;
  EXPECT_NEAR(column_values(run, "true_bias")[last], bias / kDegree, 0.01);
}

class StartedHot : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Temperatures, StartedHot,
                         testing::Values(83.0, 90.0, 100.0, 115.0));

// The envelope settles to the static solution with the drive at its limit.
TEST_P(StartedHot, RunsOnWithItsStatusBit) {
  const DeviceParameters device = nominal_device({"readout.adc_bits=32"});
  const std::string constant =
      ambient("constant_degC = " + std::to_string(GetParam()));
  const Recording envelope = run_at(scenario_from("", constant, "3", "20"),
                                    Fidelity::kEnvelope, device);
  const Recording slow = run_at(scenario_from("", constant, "3", "20"),
                                Fidelity::kQuasistatic, device);
  const std::size_t last = envelope.time.size() - 1;
  ASSERT_EQ(envelope.time.size(), 60);
  for (const std::string name : {"true_bias", "quadrature"}) {
    EXPECT_NEAR(column_values(envelope, name)[last],
                column_values(slow, name)[last], 0.02)
        << name;
  }
  for (const Recording* run : {&envelope, &slow}) {
    EXPECT_TRUE(shows(*run, last, kLoopNotLocked));
    EXPECT_EQ(column_values(*run, "drive_voltage")[last], 5);
  }
}

TEST(LossOfLock, OfACarrierRunIsThatOfTheEnvelope) {
  const DeviceParameters device = nominal_device({"readout.adc_bits=32"});
  const ScenarioPlan scenario =
      scenario_from("", ambient("constant_degC = 95"), "1.3", "100");
  const Recording envelope = run_at(scenario, Fidelity::kEnvelope, device);
  const Recording carrier = run_at(scenario, Fidelity::kCarrier, device);
  ASSERT_EQ(carrier.time.size(), 130);
  EXPECT_TRUE(shows(carrier, 129, kLoopNotLocked));
  EXPECT_EQ(carrier.status[129], envelope.status[129]);
  EXPECT_NEAR(column_values(carrier, "true_bias")[129],
              column_values(envelope, "true_bias")[129], 2e-3);
}

// Without power a sample has the bias that the gyro would settle to.
TEST(UnpoweredBias, IsTheSameInEveryFidelity) {
  const DeviceParameters device = nominal_device();
  for (const std::string motion :
       {"", "[rate]\nconstant_deg_per_s = 5\n",
        "[cross_rate]\nx = { constant_deg_per_s = 300 }\n"
        "[acceleration]\nx = { steps = [[0, 0], [3.5, 5]] }\n"}) {
    const std::string short_power = "[power]\non_s = [2]\noff_s = [2.5]\n";
    const ScenarioPlan scenario =
        scenario_from(short_power + motion,
                      ambient("points = [[0, -10], [5, -10.5]]"), "5", "20");
    const Recording slow = run_at(scenario, Fidelity::kQuasistatic, device);
    for (const Fidelity fidelity : {Fidelity::kEnvelope, Fidelity::kCarrier}) {
      const Recording run = run_at(scenario, fidelity, device);
      for (std::size_t k = 0; k < run.time.size(); ++k) {
        if (!shows(run, k, kUnpowered)) continue;
        EXPECT_NEAR(column_values(run, "true_bias")[k],
                    column_values(slow, "true_bias")[k], 1e-5)
            << fidelity_name(fidelity) << ' ' << run.time[k] << ' ' << motion;
      }
    }
  }
}

// The message of a run that is refused, or nothing.
std::string refusal(const ScenarioPlan& scenario, Fidelity fidelity,
                    const DeviceParameters& device) {
  try {
    run_at(scenario, fidelity, device);
  } catch (const SimulationFailure& error) {
    return error.what();
  }
  return "";
}

// The board is the first part that gets too hot: 0.5 s from 100 to 150 degC.
TEST(MaterialRange, IsOneForEveryFidelity) {
  const ScenarioPlan scenario =
      scenario_from("", ambient("constant_degC = 100"), "2", "50");
  const DeviceParameters device =
      nominal_device({"thermal.electronics_power_W=600"});
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope, Fidelity::kCarrier}) {
    const std::string said = refusal(scenario, fidelity, device);
    EXPECT_TRUE(said.starts_with("board at 15")) << said;
    EXPECT_TRUE(holds(said, "beyond -100 to 150 degC"));
    EXPECT_TRUE(holds(said, "thermal.electronics_power_W = 600"));
  }
}

// The heat of a run that would go beyond what any table holds.
TEST(MaterialRange, NamesTheFirstSampleHoweverHotTheRunEnds) {
  const DeviceParameters device =
      nominal_device({"thermal.electronics_power_W=600"});
  const auto said = [&](const char* duration) {
    return refusal(
        scenario_from("", ambient("constant_degC = 100"), duration, "50"),
        Fidelity::kQuasistatic, device);
  };
  EXPECT_EQ(said("300"), said("2"));
}

// At both ends of the range the model works in every fidelity.
TEST(MaterialRange, BelongsToEveryFidelity) {
  const DeviceParameters device =
      nominal_device({"thermal.electronics_power_W=0"});
  for (const double celsius : {-100.0, 149.9}) {
    const ScenarioPlan scenario = scenario_from(
        "", ambient("constant_degC = " + std::to_string(celsius)), "1.2", "20");
    for (const Fidelity fidelity :
         {Fidelity::kQuasistatic, Fidelity::kEnvelope, Fidelity::kCarrier})
      EXPECT_EQ(refusal(scenario, fidelity, device), "") << celsius;
  }
}

}  // namespace
}  // namespace beamgyro::internal::loss_of_lock_test
