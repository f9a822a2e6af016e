// SPDX-License-Identifier: MIT
#include "sim/memory/memory_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace beamgyro::internal::memory_trajectory_test {
namespace {

constexpr double kZero = 273.15, kGlass = 311.15;  // [K]

MemoryParameters nominal() {
  return {.relaxation = RelaxationParameters{6e5, 0.4, 2e-3, {}},
          .hysteresis =
              HysteresisParameters{
                  {0.5, 1.5, 4, 10}, {0.2, 0.3, 0.3, 0.2}, 4e-7, 5e-8, 3.5e-4},
          .ageing = AgeingParameters{5e4, 86400, 604800, 2e-3, -5e-3, -1e-2,
                                     -5e-2, 3e-3, 1e-2}};
}

// From 10 to 60 degC and back at 2 K/min, powered for half an hour.
ThermalLoad load() {
  return {.ambient = PiecewiseLinear({0, 1500, 2000, 3500},
                                     {283.15, 333.15, 333.15, 283.15}),
          .powered = {{0, 1800}},
          .mechanical_power = 1e-4,
          .dielectric_power = 1e-3};
}

struct MemoryRun {
  MemoryRun() : memory(UnitMemory(nominal(), kGlass, {}, 283.15)) {
    const ThermalNetwork network{ThermalParameters{}};
    integrate_temperatures(network, load(), 5000, memory.sink());
    memory.finish();
    for (int k = 0; k <= 5000; ++k) times.push_back(k);
    history = simulate_temperatures(network, load(), times);
  }
  MemoryTrajectory memory;
  std::vector<double> times;
  ThermalHistory history;
};

TEST(MemoryTrajectory, IsThatOfSmallStepsAlongTheThermalSolution) {
  const MemoryRun run;
  UnitMemory stepped(nominal(), kGlass, {}, 283.15);
  const auto& beam = run.history.temperature[kBeam];
  const auto& patches = run.history.temperature[kPzt];
  double widest = 0;
  for (std::size_t k = 0; k < run.times.size(); ++k) {
    if (k > 0) stepped.advance_patches(patches[k - 1], patches[k], 1);
    stepped.push_beam(beam[k]);
    const MemoryState want = stepped.state(patches[k]);
    const MemoryState have = run.memory.at(run.times[k], beam[k]);
    widest = std::max(widest, std::abs(want.glass_offset));
    // 1e-3 K of T_f is worth 1e-5 deg/s; a sample a second misses the turning
    // point of the beam by less than 1e-5 K.
    ASSERT_NEAR(have.glass_offset, want.glass_offset, 1e-3) << k;
    ASSERT_NEAR(have.hysteresis, want.hysteresis, 1e-5) << k;
    ASSERT_NEAR(have.decades, want.decades, 1e-7) << k;
  }
  EXPECT_GT(widest, 1);
}

// The largest error of T_f - T_f,ref [K] and of the age in decades over a load.
std::array<double, 2> errors(const ThermalLoad& load, double end,
                             double spacing) {
  const double start = load.ambient.value(0);
  const ThermalNetwork network{ThermalParameters{}};
  MemoryTrajectory memory(UnitMemory(nominal(), kGlass, {}, start));
  integrate_temperatures(network, load, end, memory.sink());
  memory.finish();
  std::vector<double> times;
  for (double t = 0; t <= end; t += spacing) times.push_back(t);
  const ThermalHistory history = simulate_temperatures(network, load, times);
  UnitMemory stepped(nominal(), kGlass, {}, start);
  const auto& beam = history.temperature[kBeam];
  const auto& patches = history.temperature[kPzt];
  std::array<double, 2> largest = {0, 0};
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k > 0) stepped.advance_patches(patches[k - 1], patches[k], spacing);
    stepped.push_beam(beam[k]);
    const MemoryState want = stepped.state(patches[k]);
    const MemoryState have = memory.at(times[k], beam[k]);
    largest[0] =
        std::max(largest[0], std::abs(have.glass_offset - want.glass_offset));
    largest[1] = std::max(largest[1], std::abs(have.decades - want.decades));
  }
  return largest;
}

TEST(MemoryTrajectory, HoldsOnSlowRampsAndInAStore) {
  // Heating and cooling at 0.2 K/min through the glass transition.
  const auto slow =
      errors({.ambient = PiecewiseLinear({0, 12000, 24000},
                                         {kZero + 15, kZero + 55, kZero + 15}),
              .powered = {{0}},
              .mechanical_power = 1e-4},
             24000, 2);
  EXPECT_LT(slow[0], 1e-3);  // 1e-5 deg/s
  EXPECT_LT(slow[1], 1e-5);
  // 300 h at 40 degC of a unit of a week: a decade is worth some deg/s.
  const auto store = errors(
      {.ambient = PiecewiseLinear({0, 9000, 1.08e6}, {298.15, 313.15, 313.15})},
      1.08e6, 10);
  EXPECT_LT(store[0], 1e-3);
  EXPECT_LT(store[1], 1e-5);
}

TEST(MemoryTrajectory, RangeHoldsEveryState) {
  const MemoryRun run;
  const auto& beam = run.history.temperature[kBeam];
  for (std::size_t k = 0; k < run.times.size(); k += 7) {
    const MemoryState state = run.memory.at(run.times[k], beam[k]);
    const MemoryRange range = run.memory.range(beam[k] - 0.5, beam[k] + 0.5);
    EXPECT_GE(state.glass_offset, range.low.glass_offset - 1e-3);
    EXPECT_LE(state.glass_offset, range.high.glass_offset + 1e-3);
    EXPECT_GE(state.hysteresis, range.low.hysteresis - 1e-9);
    EXPECT_LE(state.hysteresis, range.high.hysteresis + 1e-9);
    EXPECT_GE(state.decades, range.low.decades);
    EXPECT_LE(state.decades, range.high.decades);
  }
}

TEST(UnitMemory, BeginsAsCooledThroughTheGlassTransition) {
  UnitMemory memory(nominal(), kGlass, {}, kZero + 5);
  // 1 K/min ends at 34.206 degC (V49), from however far above T_g.
  EXPECT_NEAR(memory.relaxation()->fictive_temperature() - kZero, 34.206, 0.01);
  EXPECT_NEAR(memory.state(kZero + 5).hysteresis, 1, 1e-12);
  EXPECT_EQ(memory.state(kZero + 5).decades, 0);
}

TEST(UnitMemory, GoesThroughItsHistory) {
  // Cooled at 20 K/min, then stored at 30 degC for 1000 h.
  UnitHistory history{PiecewiseLinear({0, 180}, {kZero + 65, kZero + 5}), 0};
  const UnitMemory quenched(nominal(), kGlass, history, kZero + 5);
  EXPECT_NEAR(quenched.relaxation()->fictive_temperature() - kZero, 38.143,
              0.01);
  history.temperature =
      PiecewiseLinear({0, 180, 300, 300 + 3.6e6},
                      {kZero + 65, kZero + 5, kZero + 30, kZero + 30});
  history.age = 3.6e6;  // trimmed when the storage began
  UnitMemory stored(nominal(), kGlass, history, kZero + 30);
  EXPECT_LT(stored.relaxation()->fictive_temperature(),
            quenched.relaxation()->fictive_temperature() - 1);
  EXPECT_NEAR(
      stored.state(kZero + 30).decades,
      std::log10((604800 + 86400 + 3.6e6 * ageing_rate(5e4, kZero + 30)) /
                 (604800 + 86400)),
      1e-3);
}

TEST(UnitMemory, AnAgeLetsTheGlassRelaxAtTheTemperatureOfItsRest) {
  constexpr double kYear = 3.15576e7, kRest = kZero + 25;  // [s] [K]
  const UnitMemory aged(nominal(), kGlass, {{}, kYear}, kRest);
  const UnitMemory stored(nominal(), kGlass,
                          {PiecewiseLinear({0, kYear}, {kRest, kRest}), kYear},
                          kRest);
  const auto fictive = [](const UnitMemory& memory) {
    return memory.relaxation()->fictive_temperature() - kZero;
  };
  EXPECT_EQ(fictive(aged), fictive(stored));
  EXPECT_EQ(aged.state(kRest).decades, stored.state(kRest).decades);
  // An independent integration of (12.1) ends at 25.3 degC.
  EXPECT_NEAR(fictive(aged), 25.3, 0.05);

  // A year of which the history tells the last 10 h only.
  const UnitMemory partly(nominal(), kGlass,
                          {PiecewiseLinear({0, 36000}, {kRest, kRest}), kYear},
                          kRest);
  EXPECT_NEAR(fictive(partly), fictive(aged), 1e-3);
}

TEST(UnitMemory, IsBroughtAtAKelvinAMinuteToWhereTheRunBegins) {
  const auto fictive = [](const UnitHistory& history, double start) {
    return UnitMemory(nominal(), kGlass, history, start)
               .relaxation()
               ->fictive_temperature() -
           kZero;
  };
  // From 60 to 5 degC at 1 K/min as in V49, not in no time.
  const double hot = kZero + 60;
  EXPECT_NEAR(fictive({PiecewiseLinear({0, 36000}, {hot, hot}), 0}, kZero + 5),
              34.206, 0.01);
  // A unit that has rested for a year, taken through its glass transition.
  EXPECT_NEAR(fictive({{}, 3.15576e7}, hot), 60, 1e-3);
}

TEST(UnitMemory, TheWayToTheBeginOfTheRunIsNoAge) {
  const UnitHistory history{
      PiecewiseLinear({0, 3600}, {kZero + 25, kZero + 25}), 3600};
  EXPECT_EQ(
      UnitMemory(nominal(), kGlass, history, kZero + 60).state(298.15).decades,
      UnitMemory(nominal(), kGlass, history, kZero + 25).state(298.15).decades);
}

TEST(UnitMemory, AgesFromItsTrimOn) {
  // 100 h at 60 degC, of which the trim leaves out the first 90; then 1000 h
  // that no history tells of, at 25 degC.
  const double hour = 3600, hot = kZero + 60;
  UnitHistory history{PiecewiseLinear({0, 100 * hour}, {hot, hot}), 10 * hour};
  const auto decades = [&] {
    return UnitMemory(nominal(), kGlass, history, hot).state(hot).decades;
  };
  const double born = 604800 + 86400, rate = ageing_rate(5e4, hot);
  EXPECT_NEAR(decades(), std::log10(1 + 10 * hour * rate / born), 1e-9);
  history.age = 1100 * hour;
  EXPECT_NEAR(decades(),
              std::log10(1 + (1000 * hour + 100 * hour * rate) / born), 1e-9);
}

}  // namespace
}  // namespace beamgyro::internal::memory_trajectory_test
