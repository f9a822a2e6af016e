// SPDX-License-Identifier: MIT
// Every shipped device runs, and shows what its file says it teaches.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/dynamics/gyro.h"
#include "sim/scenario/simulation.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::shipped_devices_test {
namespace {

DeviceParameters shipped(const std::string& name) {
  Overrides none;
  const ConfigDocument document = ConfigDocument::read(
      std::string(BEAMGYRO_SCENARIOS) + "/devices/" + name + ".toml", none);
  const DeviceParameters device = read_device(document);
  document.reject_unknown_keys();
  return device;
}

// Zero-rate output over -40 .. 50 degC of beam and board [deg/s].
std::vector<double> bias_curve(const TrimmedGyro& gyro) {
  std::vector<double> curve;
  for (int celsius = -40; celsius <= 50; ++celsius) {
    const double T = celsius + kZeroCelsius;
    curve.push_back(zero_rate_output(gyro, T) / kDegree);
  }
  return curve;
}

// What a least-squares cubic leaves, root mean square.
double cubic_residual(const std::vector<double>& curve) {
  const auto n = static_cast<Eigen::Index>(curve.size());
  Eigen::MatrixXd terms(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = 2.0 * static_cast<double>(i) / static_cast<double>(n) - 1;
    terms.row(i) << 1, x, x * x, x * x * x;
  }
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(curve.data(), n);
  const Eigen::VectorXd left = y - terms * reference::least_squares(terms, y);
  return left.norm() / std::sqrt(static_cast<double>(n));
}

class ShippedDevice : public testing::TestWithParam<std::string> {};

TEST_P(ShippedDevice, RunsAtBothFidelitiesAndKeepsItsTrims) {
  const DeviceParameters device = shipped(GetParam());
  ScenarioPlan scenario = scenario_from(
      "[rate]\nsteps = [[0, 0], [1.5, 20]]\n[noise]\nenabled = false\n",
      "[ambient]\nconstant_degC = 25\n", "3", "10");
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope}) {
    scenario.fidelity = fidelity;
    const Recording run = simulated(scenario, device);
    const std::vector<double>& rate = column_values(run, "rate");
    // The board warms by some 0.1 K/s. Its offset follows by 0.010 deg/s/K, and
    // its phase by 1.5e-4 rad/K, which lets in as much of 40 deg/s of
    // quadrature. The rest is half a step of 16 bits over 300 deg/s, and less
    // than 2e-4 deg/s of the beam.
    const double board = column_values(run, "true_board_temperature")[14];
    EXPECT_NEAR(rate[14], 0.5 + (0.010 + 40 * 1.5e-4) * (board - 25), 2.5e-3);
    // A whole step, and another 0.15 K of the board.
    EXPECT_NEAR(rate.back() - rate[14], 20, 7e-3);
    EXPECT_EQ(run.status.back(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedDevice,
                         testing::Values("nominal", "rebalance", "matched",
                                         "hard_pzt", "metal_mount", "oven"));

TEST(ShippedDevices, MatchedModesHaveTwelveTimesTheSignal) {
  const double nominal = std::abs(make_gyro(shipped("nominal")).rate_axis);
  const double matched = std::abs(make_gyro(shipped("matched")).rate_axis);
  EXPECT_NEAR(matched / nominal, 12, 0.5);
}

TEST(ShippedDevices, AMetalMountLeavesAlmostTheDriftButMostlyACubic) {
  const std::vector<double> elastomer =
      bias_curve(make_gyro(shipped("nominal")));
  const std::vector<double> metal =
      bias_curve(make_gyro(shipped("metal_mount")));
  const auto span = [](const std::vector<double>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    return *high - *low;
  };
  EXPECT_GT(span(metal), 0.8 * span(elastomer));
  EXPECT_LT(cubic_residual(metal), 0.5 * cubic_residual(elastomer));
}

TEST(ShippedDevices, HardCeramicDoublesQ) {
  const auto loss = [](const std::string& name) {
    const TrimmedGyro gyro = make_gyro(shipped(name));
    return gyro.beam.timoshenko_frequency *
           modal_at(gyro, kCalibrationTemperature).damping(0, 0);
  };
  EXPECT_NEAR(loss("nominal") / loss("hard_pzt"), 2.1, 0.2);
}

TEST(ShippedDevices, TheOvenHoldsTheBeamOverTheAmbientRange) {
  const DeviceParameters oven = shipped("oven");
  std::vector<double> beam, bias;
  for (const int celsius : {-40, 0, 50}) {
    const Recording run = simulated(
        scenario_from(
            "", "[ambient]\nconstant_degC = " + std::to_string(celsius) + "\n",
            "7200", "0.1"),
        oven, {});
    beam.push_back(column_values(run, "true_beam_temperature").back());
    bias.push_back(column_values(run, "true_bias").back());
  }
  EXPECT_NEAR(beam[0], 65, 0.5);
  EXPECT_NEAR(beam[2], beam[0], 0.5);
  // The board still follows the ambient: its phase and offset are left.
  EXPECT_LT(std::abs(bias[2] - bias[0]), 2.0);
}

TEST(ShippedDevices, RebalancePaysWithThePatchThatPushesBack) {
  const TrimmedGyro gyro = make_gyro(shipped("rebalance"));
  const auto slope = [&](double T) {
    return rate_slope(gyro, modal_at(gyro, T), T);
  };
  const double per_kelvin = (slope(308.15) - slope(288.15)) / 20;
  EXPECT_NEAR(per_kelvin, -0.003, 0.0005);
}

}  // namespace
}  // namespace beamgyro::internal::shipped_devices_test
