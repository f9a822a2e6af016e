// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "tests/config/rejection.h"

namespace beamgyro::internal::thermal_network_test {
namespace {

NodeVector warm_state() {
  NodeVector temperature;
  temperature << 301.2, 301.5, 300.1, 303.7, 309.3, 305.8;
  return temperature;
}

TEST(ThermalNetwork, NothingHappensAtAmbientWithoutPower) {
  const ThermalNetwork network{ThermalParameters{}};
  for (const bool stirred : {false, true}) {
    const NodeVector rate = network.heating_rate(
        NodeVector::Constant(250.0), NodeVector::Zero(), {250.0, stirred});
    // Roundoff of conductance times absolute temperature over capacity.
    EXPECT_LT(rate.cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(ThermalNetwork, EachSourceHeatsItsOwnNode) {
  const ThermalNetwork network{ThermalParameters{}};
  const NodeVector power = network.powered_heating(2e-4, 3e-6);
  const NodeVector rate =
      network.heating_rate(NodeVector::Constant(300.0), power, {300.0, false});
  EXPECT_NEAR(rate(kBeam), 2e-4 / 1.46, 1e-12);
  EXPECT_NEAR(rate(kPzt), 3e-6 / 0.08, 1e-12);
  EXPECT_NEAR(rate(kBoard), 0.60 / 6, 1e-12);
  EXPECT_NEAR(rate(kMount), 0, 1e-12);
  EXPECT_NEAR(rate(kHousing), 0, 1e-12);
  EXPECT_NEAR(rate(kSensor), 0, 1e-12);
}

TEST(ThermalNetwork, HeatLossFollowsItsLaws) {
  const ThermalNetwork network{ThermalParameters{}};
  const double T = 310, Ta = 290, d = T - Ta, A = 8e-3;
  const HeatLoss still = network.heat_loss(T, {Ta, false});
  EXPECT_NEAR(still.natural_convection,
              1.42 * A * std::pow(0.04, -0.25) * std::pow(d, 1.25), 1e-13);
  EXPECT_NEAR(still.radiation,
              0.25 * 5.670374419e-8 * A * (std::pow(T, 4) - std::pow(Ta, 4)),
              1e-13);
  EXPECT_EQ(still.forced_convection, 0);
  EXPECT_NEAR(still.fixture, 0.060 * d, 1e-13);
  const HeatLoss stirred = network.heat_loss(T, {Ta, true});
  EXPECT_NEAR(stirred.forced_convection, 20 * A * d, 1e-13);
  EXPECT_EQ(stirred.natural_convection, still.natural_convection);
}

TEST(ThermalNetwork, ColdHousingTakesHeatByTheSameNaturalConvection) {
  const ThermalNetwork network{ThermalParameters{}};
  EXPECT_EQ(network.heat_loss(280, {290, false}).natural_convection,
            -network.heat_loss(300, {290, false}).natural_convection);
}

TEST(ThermalNetwork, JacobianAgreesWithCentralDifferences) {
  const ThermalNetwork network{ThermalParameters{}};
  const double h = 1e-3;  // [K]
  for (const double ambient : {233.15, 303.6, 310.0}) {
    for (const bool stirred : {false, true}) {
      const ThermalSurroundings surroundings{ambient, stirred};
      const NodeMatrix jacobian =
          network.heating_rate_jacobian(warm_state(), surroundings);
      for (int j = 0; j < kThermalNodeCount; ++j) {
        const NodeVector step = h * NodeVector::Unit(j);
        const NodeVector slope =
            (network.heating_rate(warm_state() + step, NodeVector::Zero(),
                                  surroundings) -
             network.heating_rate(warm_state() - step, NodeVector::Zero(),
                                  surroundings)) /
            (2 * h);
        EXPECT_LT((slope - jacobian.col(j)).cwiseAbs().maxCoeff(), 1e-8)
            << "node " << kThermalNodeNames[static_cast<std::size_t>(j)]
            << ", ambient " << ambient;
      }
    }
  }
}

TEST(ThermalNetwork, SteadyStatePassesAllHeatToTheAir) {
  ThermalParameters sealed;
  sealed.housing_fixture_conductance = 0;
  sealed.housing_emissivity = 0;
  const ThermalNetwork network{sealed};
  const NodeVector power = network.powered_heating(0, 0);
  const NodeVector T = network.steady_state(power, {300.0, false});
  // 0.60 W = k d^(5/4)
  const double k = 1.42 * 8e-3 * std::pow(0.04, -0.25);
  EXPECT_NEAR(T(kHousing) - 300, std::pow(0.60 / k, 0.8), 1e-9);
  EXPECT_NEAR(T(kBeam), T(kHousing), 1e-9);
}

TEST(ThermalNetwork, SteadyStateWithoutPowerIsAmbient) {
  const ThermalNetwork network{ThermalParameters{}};
  const NodeVector T = network.steady_state(NodeVector::Zero(), {260, true});
  EXPECT_LT((T.array() - 260).abs().maxCoeff(), 1e-9);
}

std::string rejection_of(const std::function<void(ThermalParameters&)>& spoil) {
  ThermalParameters parameters;
  spoil(parameters);
  return rejection([&] { const ThermalNetwork network(parameters); });
}

TEST(ThermalNetwork, RejectsEveryNumberThatIsNegativeOrNotFinite) {
  for (const auto& field : thermal_fields()) {
    for (const double bad : {-1e-3, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
      const std::string message =
          rejection_of([&](ThermalParameters& p) { p.*field.value = bad; });
      EXPECT_TRUE(holds(message, field.key));
    }
  }
}

TEST(ThermalNetwork, RejectsAnOvenThatCannotWork) {
  using Field = std::pair<const char*, double ThermalOven::*>;
  for (const auto& [key, value] :
       {Field{"set_point_degC", &ThermalOven::set_point},
        Field{"max_power_W", &ThermalOven::max_power},
        Field{"proportional_W_per_K", &ThermalOven::proportional_gain},
        Field{"integral_time_s", &ThermalOven::integral_time}}) {
    ThermalOven oven;
    oven.*value = -1e3;
    const std::string message =
        rejection_of([&](ThermalParameters& p) { p.oven = oven; });
    EXPECT_TRUE(holds(message, key));
  }
}

TEST(ThermalNetwork, RejectsANodeThatNothingJoins) {
  using P = ThermalParameters;
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_TRUE(holds(message, part));
  };
  says(rejection_of([](P& p) { p.beam_pzt_conductance = 0; }), "the pzt to");
  says(rejection_of([](P& p) {
         p.beam_mount_conductance = p.beam_housing_conductance = 0;
       }),
       "the beam to");
  says(rejection_of([](P& p) {
         p.mount_housing_conductance = p.beam_housing_conductance = 0;
       }),
       "the beam to");
  says(rejection_of([](P& p) {
         p.mount_housing_conductance = p.beam_mount_conductance = 0;
       }),
       "the mount to");
  says(rejection_of([](P& p) {
         p.housing_board_conductance = p.board_sensor_conductance = 0;
       }),
       "the board to");
  says(rejection_of([](P& p) {
         p.housing_sensor_conductance = p.board_sensor_conductance = 0;
       }),
       "the sensor to");
  says(rejection_of([](P& p) {
         p.housing_fixture_conductance = p.housing_emissivity =
             p.natural_convection_coefficient = 0;
       }),
       "the housing to the surroundings");
  ThermalParameters joined;
  joined.beam_housing_conductance = 0;
  EXPECT_NO_THROW(ThermalNetwork{joined});
}

}  // namespace
}  // namespace beamgyro::internal::thermal_network_test
