// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::run_threads_test {
namespace {

constexpr std::size_t kDevices = 8;
const std::string kRate =
    "[rate.random]\nrms_deg_per_s = 3\nbandwidth_Hz = 2\n";

// Devices that differ in what is solved, tabulated and integrated.
DeviceParameters device(std::size_t i) {
  return nominal_device({"bond.glass_transition_degC=" + std::to_string(30 + i),
                         "mount.axis_angle_deg=" + std::to_string(1 + i),
                         "thermal.electronics_power_W=0." + std::to_string(i)});
}

Recording run(const ScenarioPlan& scenario, std::size_t i) {
  const TrimmedGyro gyro = make_gyro(device(i));
  const RunKey key{.device = static_cast<std::uint32_t>(i), .run = 0};
  return simulated(scenario, gyro, key);
}

std::vector<Recording> runs(const ScenarioPlan& scenario, int threads) {
  std::vector<Recording> all(kDevices);
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> workers;
  for (int t = 0; t < threads; ++t) {
    workers.emplace_back([&] {
      for (std::size_t i = next++; i < kDevices; i = next++)
        all[i] = run(scenario, i);
    });
  }
  for (std::thread& worker : workers) worker.join();
  return all;
}

class RunThreads : public testing::TestWithParam<Fidelity> {};

TEST_P(RunThreads, EightDevicesGiveTheSameBitsOnOneThreadAndOnFour) {
  ScenarioPlan scenario =
      scenario_from(kRate, "[ambient]\npoints = [[0, 20], [10, 45]]\n", "5");
  if (GetParam() == Fidelity::kEnvelope) scenario.duration = 1.5;
  if (GetParam() == Fidelity::kCarrier) {
    scenario.duration = 0.01;
    scenario.output_rate = 1000;
  }
  scenario.fidelity = GetParam();
  const std::vector<Recording> one = runs(scenario, 1);
  const std::vector<Recording> four = runs(scenario, 4);
  for (std::size_t i = 0; i < kDevices; ++i) {
    EXPECT_TRUE(same_bits(one[i], four[i])) << "device " << i;
    EXPECT_FALSE(same_bits(one[i], one[(i + 1) % kDevices])) << "device " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Fidelities, RunThreads,
                         testing::Values(Fidelity::kQuasistatic,
                                         Fidelity::kEnvelope,
                                         Fidelity::kCarrier));

TEST(PreparedGyro, ServesManyRunsLikeTheDeviceItself) {
  const TrimmedGyro gyro = make_gyro(device(3));
  for (const char* ambient : {"20", "60"}) {
    ScenarioPlan scenario = scenario_from(
        kRate, std::string("[ambient]\nconstant_degC = ") + ambient + "\n",
        "10");
    EXPECT_TRUE(
        same_bits(simulated(scenario, gyro), simulated(scenario, device(3))));
  }
}

}  // namespace
}  // namespace beamgyro::internal::run_threads_test
