// SPDX-License-Identifier: MIT
// Borders of inputs that rounding keeps from coinciding.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "random/random_stream.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/simulation.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::timeline_test {
namespace {

const TrimmedGyro& fine_gyro() {
  static const TrimmedGyro gyro =
      make_gyro(nominal_device({"readout.adc_bits=32"}));
  return gyro;
}

Recording run_of(ScenarioPlan scenario, Fidelity fidelity) {
  scenario.fidelity = fidelity;
  scenario.noise_enabled = false;
  return simulated(scenario, fine_gyro());
}

double value_at(const Recording& run, const char* column, double t) {
  const auto k = std::lower_bound(run.time.begin(), run.time.end(), t - 1e-6) -
                 run.time.begin();
  return column_values(run, column)[static_cast<std::size_t>(k)];
}

TEST(Timeline, AStepOneRoundingAfterTheLockTimeOfAPowerOnIsAStep) {
  // 0.36 + 1 is 1.3599999999999999: locking is due a rounding before the step.
  const ScenarioPlan scenario = scenario_from(
      "[power]\non_s = [0.36]\n[rate]\nsteps = [[0, 0], [1.36, 10]]\n",
      "[ambient]\nconstant_degC = 25\n", "5", "10");
  const Recording run = run_of(scenario, Fidelity::kEnvelope);
  for (const double t : {2.0, 3.0, 4.0}) {
    EXPECT_NEAR(value_at(run, "rate", t) - value_at(run, "true_bias", t), 10,
                0.01)
        << t;
  }
}

TEST(Timeline, PowerGoesOffAtTheEndOfASoakProgramme) {
  // Three holds of 4500 s and 140 K at 7 K/min: the sum is 14699.999999999998.
  const ScenarioPlan scenario = scenario_from(
      "[power]\non_s = [0]\noff_s = [14700]\n[chamber]\nstirred = true\n",
      "[ambient.soaks]\ntemperatures_degC = [20, -30, 60]\nhold_s = 4500\n"
      "ramp_K_per_min = 7\n",
      "22000", "0.1");
  for (const Fidelity fidelity :
       {Fidelity::kQuasistatic, Fidelity::kEnvelope}) {
    const Recording run = run_of(scenario, fidelity);
    EXPECT_NEAR(value_at(run, "true_board_temperature", 21990), 60, 0.01);
  }
}

TEST(Timeline, PowerComesOnOneRoundingAfterASoaksEnd) {
  ScenarioPlan scenario = scenario_from(
      "",
      "[ambient.soaks]\ntemperatures_degC = [25, 30]\nhold_s = 10\n"
      "ramp_K_per_min = 60\n",
      "13", "10");
  scenario.powered = {{std::nextafter(10.0, 11.0)}};
  const Recording run = run_of(scenario, Fidelity::kEnvelope);
  EXPECT_EQ(run.status.back(), 0);
  EXPECT_GT(value_at(run, "true_board_temperature", 12.9),
            value_at(run, "true_ambient_temperature", 10) + 0.1);
}

TEST(Timeline, BordersMoveToTheSampleOrTheDecimalsThatAreThere) {
  const auto after = [](double t) { return std::nextafter(t, 1e9); };
  ScenarioPlan scenario = scenario_from("");  // at 10 Hz
  scenario.powered = {{after(0.3), 0.1 + 0.6}, {after(20.123), 1e7 / 3}};
  scenario.ambient =
      PiecewiseLinear({0.3, after(40.01), 50.01}, {300, 301, 302});
  scenario.motion[kRateZ] = PiecewiseLinear(
      {20.123, after(20.123), 40.01, 50, after(50), after(after(50))},
      {1, 2, 3, 4, 5, 6});
  const ScenarioPlan aligned = with_aligned_borders(scenario);
  EXPECT_EQ(aligned.powered[0].on, 0.3);
  EXPECT_EQ(aligned.powered[0].off, 0.7);
  EXPECT_EQ(aligned.powered[1].on, 20.123);
  EXPECT_EQ(aligned.powered[1].off, 1e7 / 3);
  EXPECT_EQ(aligned.ambient.times(), (std::vector<double>{0.3, 40.01, 50.01}));
  const auto& rate = std::get<PiecewiseLinear>(aligned.motion[kRateZ]);
  EXPECT_EQ(rate.times(), (std::vector<double>{20.123, 20.123, 40.01, 50, 50}));
  EXPECT_EQ(rate.values(), (std::vector<double>{1, 2, 3, 4, 6}));
}

TEST(Timeline, BendsThatAreAloneStay) {
  ScenarioPlan scenario = scenario_from("");
  scenario.ambient =
      PiecewiseLinear({std::nextafter(0.3, 1), 7.0 / 3}, {300, 301});
  EXPECT_EQ(with_aligned_borders(scenario).ambient.times(),
            scenario.ambient.times());
}

TEST(Timeline, APowerCycleNoLongerThanRoundingIsRefused) {
  for (const char* power :
       {"[power]\non_s = [0, 0.3]\noff_s = [0.30000000000000004, 9]\n",
        "[power]\non_s = [0, 0.30000000000000004]\noff_s = [0.3, 9]\n"}) {
    EXPECT_TRUE(
        holds(rejection([&] { scenario_from(power); }), "on and off in turn"));
  }
}

// A stream of whole numbers below a limit.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : stream_(seed, 0, 0, kRateProfileStream) {}
  int below(int limit) { return static_cast<int>(limit * stream_.uniform()); }

 private:
  RandomStream stream_;
};

// A scenario of three borders at which inputs jump and bend together, each at a
// time of its own: `nudge` makes it of the border.
template <class Nudge>
ScenarioPlan scenario_of_borders(std::uint32_t seed, double duration,
                                 double output_rate, const Nudge& nudge) {
  Dice dice(seed);
  ScenarioPlan scenario = scenario_from("");
  scenario.duration = duration;
  scenario.output_rate = output_rate;
  std::vector<double> borders;  // on samples, on a random motion's or anywhere
  const double bandwidth = duration > 1 ? 4 : 80;  // of a random motion [Hz]
  const double grids[] = {output_rate, 16 * bandwidth, 1e5};
  for (int i = 1; i <= 3; ++i) {
    const double grid = grids[dice.below(3)];
    const double t = duration * (i + 0.01 * dice.below(80)) / 5;
    borders.push_back(std::round(t * grid) / grid);
  }
  const auto border = [&](std::size_t i) { return nudge(borders[i]); };
  const auto value = [&](double scale) {
    return scale * (dice.below(2001) - 1000) / 1000;
  };
  const auto steps = [&](double scale) {
    const double a = value(scale), b = value(scale), c = value(scale);
    const double first = border(1), last = border(2);
    return PiecewiseLinear({first, first, last, last}, {a, b, b, c});
  };
  const auto bends = [&](double scale) {
    return PiecewiseLinear({border(0), border(1), border(2)},
                           {value(scale), value(scale), value(scale)});
  };
  scenario.ambient =
      PiecewiseLinear(borders, {300, 300 + value(5), 300 + value(5)});
  scenario.motion[kRateX] = bends(0.3);
  if (dice.below(3) == 0)
    scenario.motion[kRateY] = RandomRate{.rms = 0.1, .bandwidth = bandwidth};
  if (dice.below(4) == 0) return scenario;  // nothing jumps
  if (dice.below(3) == 0) {
    scenario.powered = {{0, border(0)}, {border(1), border(2)}};
  } else {
    scenario.powered = {{border(0)}};
  }
  scenario.motion[kRateZ] = steps(0.3);
  scenario.ambient = PiecewiseLinear({0, border(1), border(2)},
                                     {300, 300 + value(5), 300 + value(5)});
  if (dice.below(2) > 0) scenario.motion[kAccelerationZ] = steps(20);
  return scenario;
}

std::string difference(const Recording& a, const Recording& b) {
  if (a.status != b.status) return "status";
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    const auto &x = a.columns[i].values, &y = b.columns[i].values;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (std::isnan(x[k]) && std::isnan(y[k])) continue;
      if (!(std::abs(x[k] - y[k]) <= 1e-9))
        return fmt::format("{} at {} s: {} and {}", a.columns[i].name,
                           a.time[k], x[k], y[k]);
    }
  }
  return "";
}

const TrimmedGyro& finest_gyro() {
  static const TrimmedGyro gyro = make_gyro(nominal_device(
      {"readout.adc_bits=32", "readout.drive_frequency_resolution_Hz=1e-10",
       "readout.drive_voltage_resolution_V=1e-10",
       "readout.quadrature_resolution_deg_per_s=1e-10",
       "temperature_sensor.resolution_K=1e-10"}));
  return gyro;
}

class BordersARoundingApart : public testing::TestWithParam<Fidelity> {};

TEST_P(BordersARoundingApart, AreOneBorder) {
  const bool carrier = GetParam() == Fidelity::kCarrier;
  const double duration = carrier ? 0.1 : 3.0;
  const double output_rate = carrier ? 1000 : 20;
  const std::uint32_t seeds = carrier ? 4 : 12;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    Dice dice(seed + 1000);
    const auto run = [&](const auto& nudge) {
      ScenarioPlan scenario =
          scenario_of_borders(seed, duration, output_rate, nudge);
      scenario.fidelity = GetParam();
      scenario.noise_enabled = false;
      return simulated(scenario, finest_gyro());
    };
    const Recording exact = run([](double t) { return t; });
    const Recording nudged = run([&](double t) {
      const double towards = dice.below(2) > 0 ? 1e9 : -1e9;
      for (int ulps = 1 + dice.below(3); ulps > 0; --ulps)
        t = std::nextafter(t, towards);
      return t;
    });
    EXPECT_EQ(difference(exact, nudged), "") << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Fidelities, BordersARoundingApart,
                         testing::Values(Fidelity::kQuasistatic,
                                         Fidelity::kEnvelope,
                                         Fidelity::kCarrier));

}  // namespace
}  // namespace beamgyro::internal::timeline_test
