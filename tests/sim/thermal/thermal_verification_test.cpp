// SPDX-License-Identifier: MIT
// Verification tests V35 to V39 and the lag of a ramp.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/thermal/thermal_run.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::thermal_verification_test {
namespace {

constexpr double kBeamNodePower = 1e-4;  // [W]
constexpr double kAmbient = 298.15;      // [K], of the warm-up

std::vector<double> every(double step, double end) {
  std::vector<double> times;
  for (int k = 0; k * step <= end; ++k) times.push_back(k * step);
  return times;
}

TEST(Verification, V35EveryJouleIsAccountedFor) {
  const ThermalNetwork network{ThermalParameters{}};
  NodeVector T, P;
  T << 301.2, 301.5, 300.1, 303.7, 309.3, 305.8;
  P << 1e-4, 6e-7, 0.5, 0.02, 0.6, 1e-3;
  for (const double ambient : {233.15, 298.15, 303.7, 323.15}) {
    for (const bool stirred : {false, true}) {
      const ThermalSurroundings around{ambient, stirred};
      const double stored =
          network.heat_capacity().dot(network.heating_rate(T, P, around));
      const double loss = network.heat_loss(T(kHousing), around).total();
      EXPECT_NEAR(stored, P.sum() - loss, 1e-12 * (P.sum() + std::abs(loss)))
          << "ambient " << ambient;
    }
  }
}

TEST(Verification, V36SteadyStateLosesWhatItIsGiven) {
  const ThermalNetwork network{ThermalParameters{}};
  const NodeVector power = network.powered_heating(kBeamNodePower, 6e-7);
  for (const double ambient : {233.15, 273.15, 298.15, 323.15}) {
    for (const bool stirred : {false, true}) {
      const ThermalSurroundings around{ambient, stirred};
      const NodeVector T = network.steady_state(power, around);
      const double loss = network.heat_loss(T(kHousing), around).total();
      EXPECT_NEAR(loss / power.sum(), 1, 1e-8) << "ambient " << ambient;
    }
  }
}

TEST(Verification, V37PureConvectionCoolsByTheClosedForm) {
  // The housing alone: conductances that carry 1e-15 of the heat.
  ThermalParameters alone;
  alone.beam_mount_conductance = alone.beam_housing_conductance =
      alone.mount_housing_conductance = alone.housing_board_conductance =
          alone.board_sensor_conductance = alone.housing_sensor_conductance =
              1e-15;
  alone.housing_fixture_conductance = 0;
  alone.housing_emissivity = 0;
  const ThermalNetwork network{alone};
  const double ambient = 300, start = 50, jump = 1;  // [K] [K] [s]
  const std::vector<double> times = every(50, 20000);
  const ThermalHistory history = simulate_temperatures(
      network,
      {.ambient = PiecewiseLinear({0, jump, jump},
                                  {ambient + start, ambient + start, ambient})},
      times, 1e-9);
  const double k = 1.42 * 8e-3 * std::pow(0.04, -0.25);  // [W/K^(5/4)]
  const double C = 42;                                   // [J/K]
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double exact =
        std::pow(std::pow(start, -0.25) + k / (4 * C) * (times[i] - jump), -4);
    EXPECT_NEAR((history.temperature[kHousing][i] - ambient) / exact, 1, 1e-6)
        << "t = " << times[i] << " s";
  }
}

// Conductances of the nominal unit with the fixture as the only way out.
NodeMatrix grounded_conductance() {
  const double pzt = 0.5, pins = 0.004, gap = 0.0045, base = 0.05, board = 0.12,
               sensor = 0.004, fixture = 0.06;  // [W/K]
  NodeMatrix G;
  G.row(kBeam) << pzt + pins + gap, -pzt, -pins, -gap, 0, 0;
  G.row(kPzt) << -pzt, pzt, 0, 0, 0, 0;
  G.row(kMount) << -pins, 0, pins + base, -base, 0, 0;
  G.row(kHousing) << -gap, 0, -base, gap + base + board + sensor + fixture,
      -board, -sensor;
  G.row(kBoard) << 0, 0, 0, -board, board + sensor, -sensor;
  G.row(kSensor) << 0, 0, 0, -sensor, -sensor, 2 * sensor;
  return G;
}

TEST(Verification, V38LinearNetworkLagsARampByConductanceAndCapacity) {
  ThermalParameters linear;
  linear.natural_convection_coefficient = 0;
  linear.housing_emissivity = 0;
  const double rate = 1.0 / 60;  // [K/s]
  const double end = 25000;      // [s], 29 of the longest time constants
  NodeVector C;
  C << 1.46, 0.08, 1.8, 42, 6, 0.25;
  const NodeVector lag = reference::solution(grounded_conductance(), C * rate);
  const PiecewiseLinear ramp({0, end}, {200, 200 + rate * end});
  const std::vector<double> times = {end - 100, end};
  const ThermalHistory history =
      simulate_temperatures(ThermalNetwork{linear}, {.ambient = ramp}, times);
  for (std::size_t i = 0; i < kThermalNodeCount; ++i) {
    for (const std::size_t k : {0u, 1u}) {
      const double behind = ramp.value(times[k]) - history.temperature[i][k];
      EXPECT_NEAR(behind / lag(static_cast<Eigen::Index>(i)), 1, 1e-6)
          << kThermalNodeNames[i];
    }
  }
}

class WarmUp : public testing::Test {
 protected:
  const ThermalNetwork network_{ThermalParameters{}};
  const NodeVector final_ = network_.steady_state(
      network_.powered_heating(kBeamNodePower, 0), {kAmbient, false});
  const std::vector<double> times_ = every(1, 7200);
  const ThermalHistory history_ =
      simulate_temperatures(network_,
                            {.ambient = PiecewiseLinear::constant(kAmbient),
                             .powered = {{0.0}},
                             .mechanical_power = kBeamNodePower},
                            times_);

  double rise(ThermalNode node) const { return final_(node) - kAmbient; }

  // First time [s] at which a node has made `share` of its whole rise.
  double time_to(ThermalNode node, double share) const {
    const std::vector<double>& T = history_.temperature[node];
    std::size_t k = 0;
    while (T.at(k) < kAmbient + share * rise(node)) ++k;
    return times_[k];
  }
};

using VerificationV39 = WarmUp;

TEST_F(VerificationV39, WarmUpRisesByTheStatedKelvins) {
  EXPECT_NEAR(rise(kBeam), 5.41, 0.005);
  EXPECT_NEAR(rise(kHousing), 5.40, 0.005);
  EXPECT_NEAR(rise(kBoard), 10.32, 0.005);
  EXPECT_NEAR(rise(kSensor), 7.86, 0.005);
}

TEST_F(VerificationV39, WarmUpTakesTheStatedTimes) {
  EXPECT_NEAR(time_to(kBeam, 0.63), 730, 5);
  EXPECT_NEAR(time_to(kBeam, 0.95), 1645, 5);
  EXPECT_NEAR(time_to(kBeam, 0.98), 2055, 5);
  EXPECT_NEAR(time_to(kHousing, 0.95), 1385, 5);
}

TEST_F(VerificationV39, WarmUpEndsInTheSteadyState) {
  for (int i = 0; i < kThermalNodeCount; ++i) {
    // Slowest time constant 460 s: exp(-7200/460) of 10 K is left.
    EXPECT_NEAR(history_.temperature[static_cast<std::size_t>(i)].back(),
                final_(i), 1e-5);
  }
}

// Sensor minus beam on a 1 K/min ramp in a stirred chamber, unit powered.
double sensor_ahead(const ThermalParameters& parameters, double direction) {
  const double start = 273.15 - 30 * direction;  // [K]
  const PiecewiseLinear ramp({0, 3600}, {start, start + 60 * direction});
  const std::vector<double> times = {2100};  // lags settled, 275 K to 285 K
  const ThermalHistory history =
      simulate_temperatures(ThermalNetwork{parameters},
                            {.ambient = ramp,
                             .stirred = true,
                             .powered = {{0.0}},
                             .mechanical_power = kBeamNodePower},
                            times);
  return history.temperature[kSensor][0] - history.temperature[kBeam][0];
}

TEST(RampLag, SensorLeadsTheBeamByTheStatedKelvins) {
  ThermalParameters parameters;
  parameters.beam_heat_capacity = 2.898e-3 * 502;  // [kg] [J/(kg K)]
  const double up = sensor_ahead(parameters, 1);
  const double down = sensor_ahead(parameters, -1);
  EXPECT_NEAR(up, 4.90, 0.005);
  EXPECT_NEAR(down, -0.00, 0.005);
  EXPECT_NEAR((up + down) / 2, 2.45, 0.005);
  EXPECT_NEAR((up - down) / 2, 2.45, 0.005);
}

}  // namespace
}  // namespace beamgyro::internal::thermal_verification_test
