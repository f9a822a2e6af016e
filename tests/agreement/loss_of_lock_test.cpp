// SPDX-License-Identifier: MIT
// Runs in which the drive loop does not lock, loses its lock or has no power:
// what the fidelities say there is the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/dynamics/gyro.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::loss_of_lock_test {
namespace {

Recording run_at(Scenario scenario, Fidelity fidelity, const Device& device) {
  scenario.fidelity = fidelity;
  scenario.noise_enabled = false;
  return beamgyro::simulated(scenario, device);
}

std::string ambient(const std::string& profile) {
  return "[ambient]\n" + profile + "\n";
}

BeamSignal static_signal(const Gyro& gyro, const Recording& run,
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
  const Device device = nominal_device({"readout.adc_bits=32"});
  const Gyro gyro = make_gyro(device);
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

}  // namespace
}  // namespace beamgyro::loss_of_lock_test
