// SPDX-License-Identifier: MIT
// Every form of a motion about and along every axis.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "sim/scenario/motion.h"
#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::motion_axes_test {
namespace {

constexpr double kGravity = 9.80665;  // [m/s2]

const TrimmedGyro& nominal_gyro() {
  static const TrimmedGyro gyro = make_gyro(nominal_device());
  return gyro;
}

struct AxisCase {
  std::string table, suffix, csv_column, truth;
  double unit;        // [rad/s] or [m/s2]
  double truth_unit;  // of the column of the recording
  // Its samples among those of a run.
  std::function<const std::vector<double>&(const RunSamples&)> samples;
};

AxisCase rate_axis(
    const std::string& table, const std::string& truth,
    std::function<const std::vector<double>&(const RunSamples&)> samples) {
  return {table,   "deg_per_s", "rate_deg_per_s",  truth,
          kDegree, kDegree,     std::move(samples)};
}

AxisCase acceleration_axis(const std::string& name, std::size_t i) {
  return {"acceleration." + name, "g", "acceleration_g",
          "true_acceleration_" + name, kGravity, 1,
          [i](const RunSamples& s) -> const auto& {
                                       return s.motion[kAccelerationX + i];
}
};  // namespace
}  // namespace beamgyro::internal::motion_axes_test

std::vector<AxisCase> axes() {
  return {
      rate_axis(
          "rate", "true_rate",
          [](const RunSamples& s) -> const auto& { return s.motion[kRateZ]; }),
      rate_axis(
          "cross_rate.x", "true_cross_rate_x",
          [](const RunSamples& s) -> const auto& { return s.motion[kRateX]; }),
      rate_axis(
          "cross_rate.y", "true_cross_rate_y",
          [](const RunSamples& s) -> const auto& { return s.motion[kRateY]; }),
      acceleration_axis("x", 0),
      acceleration_axis("y", 1),
      acceleration_axis("z", 2)};
}

class EveryAxis : public testing::TestWithParam<AxisCase> {
 protected:
  // The table of this axis with one form in it.
  ScenarioPlan scenario(const std::string& form,
                        const std::string& duration = "10") const {
    return scenario_from("[" + GetParam().table + "]\n" + form + "\n",
                         "[ambient]\nconstant_degC = 25\n", duration);
  }
  std::string key(const std::string& name, const std::string& value) const {
    return name + GetParam().suffix + " = " + value;
  }
  // What the axis does at `times` [s], in the unit of the file.
  std::vector<double> values(const ScenarioPlan& scenario,
                             std::vector<double> times) const {
    RunSamples samples;
    samples.time = std::move(times);
    Motion(scenario, nominal_gyro(), {}).sample(samples);
    std::vector<double> found = GetParam().samples(samples);
    for (double& v : found) v /= GetParam().unit;
    return found;
  }
  void expect(const std::string& form, const std::vector<double>& times,
              const std::vector<double>& expected) const {
    const std::vector<double> found = values(scenario(form), times);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 1e-12) << form << " at " << times[i];
  }
};

TEST_P(EveryAxis, TakesAConstant) {
  expect(key("constant_", "-3"), {0, 5, 9.9}, {-3, -3, -3});
}

TEST_P(EveryAxis, JoinsPointsAndHoldsSteps) {
  expect("points = [[2, 1], [6, 5]]", {0, 4, 9}, {1, 3, 5});
  expect("steps = [[2, 1], [6, -5]]", {0, 5.999, 6, 9}, {1, 1, -5, -5});
}

TEST_P(EveryAxis, TakesASineWithPhaseAndOffset) {
  const std::string sine = key("amplitude_", "2") + ", frequency_Hz = 0.25";
  const double w = std::numbers::pi / 2;
  expect("sine = { " + sine + " }", {0, 1.5}, {0, 2 * std::sin(1.5 * w)});
  expect(
      "sine = { " + sine + ", phase_rad = 0.5, " + key("offset_", "1") + " }",
      {0, 1.5}, {1 + 2 * std::sin(0.5), 1 + 2 * std::sin(1.5 * w + 0.5)});
}

TEST_P(EveryAxis, ReadsAFile) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) /
                                     ("profile_" + GetParam().truth + ".csv");
  std::ofstream(path) << "time_s," << GetParam().csv_column
                      << "\n2,1\n6,5\n8,-1\n";
  expect("file = \"" + path.string() + "\"", {0, 4, 7, 9}, {1, 3, 2, -1});
  std::filesystem::remove(path);
}

TEST_P(EveryAxis, RandomHasItsRms) {
  std::vector<double> times;
  for (int k = 0; k < 40000; ++k) times.push_back(0.01 * k);
  double square = 0;
  for (const double v : values(
           scenario("random = { " + key("rms_", "3") + ", bandwidth_Hz = 5 }",
                    "400"),
           times))
    square += v * v / static_cast<double>(times.size());
  // w = 48.8/s: the mean square of 400 s is known to sqrt(5 / (w T)), 1.6 %.
  EXPECT_NEAR(square / 9, 1, 3 * 0.016);
}

TEST_P(EveryAxis, AloneMovesAndIsRecordedAsTruth) {
  const Recording run =
      simulated(scenario("steps = [[0, 0], [5, 2]]"), nominal_gyro().device);
  for (const AxisCase& axis : axes()) {
    const Column* column = find_column(run, axis.truth);
    if (axis.truth != GetParam().truth) {
      if (axis.truth == "true_rate") {
        EXPECT_EQ(column->values[99], 0);
      } else {
        EXPECT_EQ(column, nullptr) << axis.truth;
      }
      continue;
    }
    ASSERT_NE(column, nullptr);
    EXPECT_EQ(column->role, Role::kTruth);
    EXPECT_EQ(column->units, axis.truth_unit == 1 ? "m/s2" : "degree/s");
    EXPECT_EQ(column->values[49], 0);
    EXPECT_NEAR(column->values[50], 2 * axis.unit / axis.truth_unit, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, EveryAxis, testing::ValuesIn(axes()),
                         [](const auto& axis) { return axis.param.truth; });

// All axes random, at 20 Hz.
RunSamples all_random(double duration) {
  std::string text;
  for (const AxisCase& axis : axes()) {
    text += "[" + axis.table + ".random]\nrms_" + axis.suffix +
            " = 1\nbandwidth_Hz = 5\n";
  }
  const ScenarioPlan scenario = scenario_from(
      text, "[ambient]\nconstant_degC = 25\n", std::to_string(duration), "20");
  RunSamples samples;
  samples.time = sample_times(scenario);
  Motion(scenario, nominal_gyro(), {}).sample(samples);
  return samples;
}

TEST(RandomAxes, AreIndependentOfEachOther) {
  const RunSamples samples = all_random(400);
  const auto correlation = [](const std::vector<double>& x,
                              const std::vector<double>& y) {
    double xy = 0, xx = 0, yy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      xy += x[k] * y[k];
      xx += x[k] * x[k];
      yy += y[k] * y[k];
    }
    return xy / std::sqrt(xx * yy);
  };
  const std::vector<AxisCase> all = axes();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // Deviation of independent ones: sqrt(2.5 / (w T)), w = 48.8/s.
      EXPECT_NEAR(correlation(all[i].samples(samples), all[j].samples(samples)),
                  0, 4 * 0.0113)
          << all[i].truth << ", " << all[j].truth;
    }
  }
}

TEST(RandomAxes, LeaveTheRateAboutTheInputAxisAsItIsAlone) {
  const PiecewiseLinear alone = realised({kDegree, 5}, 10, 7, 0, 0);
  const RunSamples samples = all_random(10);
  EXPECT_EQ(samples.motion[kRateZ], alone.sample(samples.time));
}

}  // namespace
}  // namespace beamgyro::internal::motion_axes_test
