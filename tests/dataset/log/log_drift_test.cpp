// SPDX-License-Identifier: MIT
// Temperatures and durations that mean a wrong unit of time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "dataset/log/log_import.h"
#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::log_drift_test {
namespace {

using Temperature = std::function<double(double)>;  // [degC] over [s]

// Returns what the import says about `rows` rows, one each `step` s, whose
// times are printed in s and read in `unit`. Empty: it takes them.
std::string said(const std::string& unit, int rows, double step,
                 const Temperature& temperature, const std::string& more = "") {
  const std::string map = "[time]\ncolumn = \"t\"\nunit = \"" + unit + "\"\n" +
                          gyro_and_temperature() + more;
  std::string log = "t,w,T\n";
  for (int k = 0; k < rows; ++k)
    log += fmt::format("{:.6g},0.1,{:.2f}\n", k * step, temperature(k * step));
  try {
    imported(map, log);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_asks(const std::string& message, const std::string& advice) {
  EXPECT_TRUE(holds(message, "is that right?"));
  EXPECT_TRUE(holds(message, advice));
}

// Soaks of 45 min at every kelvin from -40 to 50 degC, ramps of 0.2 K/min,
// through a sensor that follows in 60 s.
double soaked(double t) {
  constexpr double kPeriod = 3000, kHold = 2700, kLag = 60;
  const double step = std::min(std::floor(t / kPeriod), 90.0);
  const double since = t - step * kPeriod - kHold;
  const double ramp = std::clamp(since / (kPeriod - kHold), 0.0, 1.0);
  const double rest = std::exp(-(t - step * kPeriod) / kLag);
  return -40 + step + ramp - 0.2 * rest;
}

double cycled(double t) {
  return 5 + 45 * std::sin(2 * std::numbers::pi * t / 21600);
}

TEST(LogDrift, DaysInAUnitTooShortAreAskedAbout) {
  const std::string advice = R"(time.unit = "ms", "s" makes it )";
  expect_asks(said("ms", 13635, 20, soaked), advice);
  expect_asks(said("ms", 25920, 10, cycled), advice);
  expect_asks(said("us", 25920, 10, cycled),
              R"(time.unit = "us", "ms" makes it 259.19 s)");
  expect_asks(said("s", 4001, 0.001, [](double t) { return 22.75 * t - 40; }),
              R"(time.unit = "s", "min" makes it 240 s)");
  expect_asks(said("s", 101, 0.01, [](double t) { return 25 + 10 * t; }),
              "time.unit = \"s\"");
  EXPECT_EQ(said("s", 13635, 20, soaked), "");
  EXPECT_EQ(said("s", 25920, 10, cycled), "");
  EXPECT_EQ(
      said("ms", 25920, 10, cycled, "[rules]\nfast_temperature = \"keep\"\n"),
      "");
}

TEST(LogDrift, ThermalShockIsTaken) {
  // 45 K/min at the sensor, from one end of the range to the other and back.
  const auto shock = [](double t) {
    const double phase = std::fmod(t, 1200);
    return -55 + std::min({180.0, 0.75 * phase, 0.75 * (1200 - phase)});
  };
  EXPECT_EQ(said("s", 36000, 0.1, shock), "");
  EXPECT_EQ(said("s", 3600, 1, shock), "");
}

// Soaks of ten minutes, each in a log of its own, put behind each other.
TEST(LogDrift, JoinedSoaksAreTaken) {
  const auto joined = [](double t) { return 20 * std::floor(t / 600) - 20; };
  EXPECT_EQ(said("s", 2400, 1, joined), "");
}

TEST(LogDrift, ABadCellIsNoDrift) {
  const auto with_bad = [](double bad) {
    return [bad](double t) { return t == bad ? 85.0 : 25.0; };
  };
  for (const double bad : {0.0, 1.0, 20.0, 40.0})
    EXPECT_EQ(said("s", 41, 1, with_bad(bad)), "") << bad;
  EXPECT_EQ(said("ms", 41, 100, with_bad(2000)), "");
  EXPECT_EQ(said("ms", 3, 100, with_bad(100)), "");
  EXPECT_EQ(said("ms", 3, 100, with_bad(200)), "");
  expect_asks(
      said("ms", 41, 100, [](double t) { return t < 2000 ? 25 : 85.0; }),
      "look at ");
}

TEST(LogDrift, ACoarseOrNoisyThermometerIsTaken) {
  // At 200 Hz: steps of 1 K that come and go, and noise of 1 K rms.
  unsigned state = 1;
  const auto uniform = [&state] {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
  };
  EXPECT_EQ(said("s", 20000, 0.005,
                 [&](double t) { return std::round(25 + t / 4 + uniform()); }),
            "");
  EXPECT_EQ(said("s", 20000, 0.005,
                 [&](double t) {
                   return 25 + t / 4 + std::sqrt(12.0) * (uniform() - 0.5);
                 }),
            "");
}

TEST(LogDrift, ALogOfYearsIsAskedAbout) {
  const std::string message = said("s", 25920, 1e4, cycled);
  EXPECT_EQ(message.find("log.csv: lasts 8.21 years"), 0u) << message;
  EXPECT_TRUE(holds(message, R"(time.unit = "s", "ms" makes it 259190 s)"));
  const auto room = [](double) { return 25.0; };
  EXPECT_EQ(said("h", 8766, 1, room), "");
  // A clock that is set while it logs.
  const std::string set = said("s", 3, 1e9, room);
  EXPECT_TRUE(holds(set, "line 3 comes 1e+09 s after line 2"));
  EXPECT_TRUE(holds(set, "time.from"));
}

}  // namespace
}  // namespace beamgyro::internal::log_drift_test
