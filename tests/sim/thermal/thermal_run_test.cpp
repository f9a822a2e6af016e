// SPDX-License-Identifier: MIT
#include "sim/thermal/thermal_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/config/rejection.h"

namespace beamgyro::internal::thermal_run_test {
namespace {

std::vector<double> at_rate(double rate, double duration) {
  std::vector<double> times(static_cast<std::size_t>(duration * rate));
  for (std::size_t k = 0; k < times.size(); ++k) {
    times[k] = static_cast<double>(k) / rate;
  }
  return times;
}

ThermalLoad warm_up() {
  return {.ambient = PiecewiseLinear::constant(298.15),
          .powered = {{0.0}},
          .mechanical_power = 1e-4};
}

// Soaks every 15 K joined by ramps of 1 K/min, three power cycles.
ThermalLoad soaks_and_ramps() {
  return {.ambient = PiecewiseLinear({0, 1800, 2700, 4500, 5400, 6000},
                                     {283, 283, 298, 298, 313, 313}),
          .stirred = true,
          .powered = {{60, 1900}, {2500, 4500}, {5000}},
          .mechanical_power = 1e-4};
}

double largest_difference(const ThermalHistory& a, const ThermalHistory& b) {
  double largest = 0;
  for (std::size_t i = 0; i < kThermalNodeCount; ++i) {
    for (std::size_t k = 0; k < a.temperature[i].size(); ++k) {
      largest = std::max(largest,
                         std::abs(a.temperature[i][k] - b.temperature[i][k]));
    }
  }
  return largest;
}

TEST(ThermalRun, StaysWithinTenMicrokelvinOfATightReference) {
  const ThermalNetwork network{ThermalParameters{}};
  constexpr double kTight = 1e-11 * 300;
  for (const ThermalLoad& load : {warm_up(), soaks_and_ramps()}) {
    // 7.3 Hz: samples fall anywhere inside the steps.
    const std::vector<double> times = at_rate(7.3, 6000);
    EXPECT_LT(
        largest_difference(simulate_temperatures(network, load, times),
                           simulate_temperatures(network, load, times, kTight)),
        1e-5);
  }
}

TEST(ThermalRun, DoesNotDependOnTheSamplesAskedFor) {
  const ThermalNetwork network{ThermalParameters{}};
  const std::vector<double> dense = at_rate(10, 6000.1);
  const std::vector<double> few = {0, 60, 1234.5, 6000};
  const ThermalHistory all =
      simulate_temperatures(network, soaks_and_ramps(), dense);
  const ThermalHistory some =
      simulate_temperatures(network, soaks_and_ramps(), few);
  for (std::size_t i = 0; i < kThermalNodeCount; ++i) {
    for (std::size_t k = 0; k < few.size(); ++k) {
      EXPECT_NEAR(some.temperature[i][k],
                  all.temperature[i][static_cast<std::size_t>(10 * few[k])],
                  1e-12);
    }
  }
}

TEST(ThermalRun, StartsAtAmbientAndStaysThereUntilPowered) {
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork{ThermalParameters{}},
      {.ambient = PiecewiseLinear::constant(250), .powered = {{500}}},
      at_rate(1, 600));
  for (std::size_t i = 0; i < kThermalNodeCount; ++i) {
    EXPECT_EQ(history.temperature[i][0], 250);
    EXPECT_NEAR(history.temperature[i][500], 250, 1e-9);
  }
  EXPECT_GT(history.temperature[kBoard][510], 250.5);
}

TEST(ThermalRun, FirstSampleIsAmbientToTheLastBit) {
  const std::vector<double> times = {0, 1};
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork{ThermalParameters{}},
      {.ambient = PiecewiseLinear({0, 100}, {251.3, 273.9}),
       .stirred = true,
       .powered = {{0}}},
      times);
  for (const std::vector<double>& node : history.temperature) {
    EXPECT_EQ(node[0], 251.3);
  }
}

TEST(ThermalRun, CoolsBackToAmbientAfterPowerOff) {
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork{ThermalParameters{}},
      {.ambient = PiecewiseLinear::constant(298.15), .powered = {{0, 3600}}},
      at_rate(1, 4 * 3600));
  EXPECT_GT(history.temperature[kBoard][3600], 298.15 + 10);
  for (const std::vector<double>& node : history.temperature) {
    EXPECT_NEAR(node.back(), 298.15, 1e-4);
  }
}

TEST(ThermalRun, StepsGrowToManyMinutesWhereNothingHappens) {
  int steps = 0;
  integrate_temperatures(ThermalNetwork{ThermalParameters{}}, warm_up(),
                         7 * 86400.0,
                         {.on_state = [](double, const auto&) {},
                          .on_step = [&](const OdeStep&) { ++steps; }});
  EXPECT_LT(steps, 300);
}

TEST(ThermalRun, TakesDiscontinuitiesThatNearlyCoincideAsOne) {
  // 0.1 + 0.2 is not 0.3: a piece of 5.6e-17 s.
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork{ThermalParameters{}},
      {.ambient = PiecewiseLinear({0, 0.3, 0.3}, {300, 300, 310}),
       .powered = {{0.1 + 0.2}}},
      at_rate(10, 100));
  EXPECT_EQ(history.temperature[kBoard][3], 300);
  EXPECT_NEAR(history.temperature[kBoard][13], 300.1, 0.01);
}

TEST(ThermalRun, EndsWhereTheLastSampleIsAnEvent) {
  const std::vector<double> times = {0, 5, 10};
  const ThermalHistory history = simulate_temperatures(
      ThermalNetwork{ThermalParameters{}},
      {.ambient = PiecewiseLinear({0, 10, 10}, {300, 300, 350}),
       .powered = {{0, 10}}},
      times);
  EXPECT_NEAR(history.temperature[kBoard][2], 301, 0.1);
  EXPECT_TRUE(history.heater_power.empty());
}

TEST(ThermalRun, TwoThreadsGiveTheSameBits) {
  const ThermalNetwork network{ThermalParameters{}};
  const std::vector<double> times = at_rate(1, 6000);
  const auto run = [&] {
    return simulate_temperatures(network, soaks_and_ramps(), times);
  };
  const ThermalHistory alone = run();
  ThermalHistory left, right;
  std::thread other([&] { left = run(); });
  right = run();
  other.join();
  EXPECT_EQ(left.temperature, alone.temperature);
  EXPECT_EQ(right.temperature, alone.temperature);
}

std::string rejection_of(const std::function<void(ThermalLoad&)>& spoil,
                         const std::vector<double>& times = {0, 1}) {
  ThermalLoad load = warm_up();
  spoil(load);
  return rejection([&] {
    simulate_temperatures(ThermalNetwork{ThermalParameters{}}, load, times);
  });
}

TEST(ThermalRun, RejectsALoadThatIsOutOfOrder) {
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_TRUE(holds(message, part));
  };
  using Load = ThermalLoad;
  says(rejection_of([](Load& load) { load.powered = {{5, 5}}; }), "off at 5 s");
  says(rejection_of([](Load& load) {
         load.powered = {{0, 10}, {9, 20}};
       }),
       "on at 9 s");
  says(rejection_of([](Load& load) { load.mechanical_power = -1; }), "-1 W");
  says(rejection_of([](Load&) {}, {0, 2, 2}), "2 s does not come after 2 s");
  says(rejection_of([](Load&) {}, {-1, 2}), "time -1 s");
  says(rejection_of([](Load&) {}, {0, NAN}), "time nan s");
}

}  // namespace
}  // namespace beamgyro::internal::thermal_run_test
