// SPDX-License-Identifier: MIT
#include "sim/scenario/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/scenario/quasistatic_run.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro {
namespace {

constexpr double kGravity = 9.80665;

const Gyro& nominal_gyro() {
  static const Gyro gyro = make_gyro(nominal_device());
  return gyro;
}

TEST(Motion, HasItsLimitsOnBothSidesOfAStep) {
  const Scenario scenario =
      scenario_from("[rate]\nsteps = [[0, 1], [10, 3]]\n");
  const Motion motion(scenario, nominal_gyro(), {});
  EXPECT_EQ(motion.breakpoints(), std::vector<double>{10});
  EXPECT_TRUE(motion.jumps_at(10));
  EXPECT_FALSE(motion.rate_is_zero());
  EXPECT_DOUBLE_EQ(motion.segment(0, 10).at(10).z, 1 * kDegree);
  EXPECT_DOUBLE_EQ(motion.segment(10, 100).at(10).z, 3 * kDegree);
  EXPECT_EQ(motion.segment(10, 100).at_rest(20).z, 0);
  EXPECT_TRUE(motion.segment(10, 100).is_constant());
}

TEST(Motion, OfPointsBendsAndHasTheirSlope) {
  const Scenario scenario =
      scenario_from("[rate]\npoints = [[0, 0], [10, 20], [20, 0]]\n");
  const Motion motion(scenario, nominal_gyro(), {});
  EXPECT_EQ(motion.breakpoints(), (std::vector<double>{10, 20}));
  EXPECT_FALSE(motion.jumps_at(10));
  const CaseMotion up = motion.segment(0, 10).at(5);
  EXPECT_NEAR(up.z, 10 * kDegree, 1e-15);
  EXPECT_NEAR(up.z_acceleration, 2 * kDegree, 1e-15);
  EXPECT_NEAR(motion.segment(10, 20).at(12).z_acceleration, -2 * kDegree,
              1e-15);
  EXPECT_FALSE(motion.segment(0, 10).is_constant());
}

TEST(Motion, OfEveryAxisTogether) {
  const Scenario scenario = scenario_from(
      "[rate]\nsine = { amplitude_deg_per_s = 2, frequency_Hz = 0.5 }\n"
      "[cross_rate]\nx = { constant_deg_per_s = 3 }\n"
      "y = { points = [[0, 0], [100, 100]] }\n"
      "[acceleration]\nz = { constant_g = 2 }\n");
  const Motion motion(scenario, nominal_gyro(), {});
  const CaseMotion now = motion.segment(0, 100).at(7.25);
  const double angle = std::numbers::pi * 7.25;
  EXPECT_DOUBLE_EQ(now.x, 3 * kDegree);
  EXPECT_NEAR(now.y, 7.25 * kDegree, 1e-15);
  EXPECT_NEAR(now.z, 2 * kDegree * std::sin(angle), 1e-15);
  EXPECT_NEAR(now.z_acceleration,
              2 * kDegree * std::numbers::pi * std::cos(angle), 1e-14);
  EXPECT_NEAR(now.in_phase / kDegree, 2 * 0.005 + 4 * 0.002, 1e-12);
}

TEST(Motion, RandomAxesAreIndependent) {
  const std::string random =
      "{ random = { rms_deg_per_s = 5, bandwidth_Hz = 0.5 } }\n";
  const Scenario scenario =
      scenario_from("[cross_rate]\nx = " + random + "y = " + random);
  const Recording run =
      simulate_quasistatic(scenario, nominal_gyro().device, {});
  const auto& x = column_values(run, "true_cross_rate_x");
  const auto& y = column_values(run, "true_cross_rate_y");
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xy += x[k] * y[k];
    xx += x[k] * x[k];
    yy += y[k] * y[k];
  }
  EXPECT_LT(std::abs(xy) / std::sqrt(xx * yy), 0.4);  // some 100 independent
  EXPECT_GT(std::abs(x[500] - y[500]), 1e-6);
}

TEST(QuasistaticRun, ShowsAccelerationInBiasAndTruth) {
  const Device device =
      nominal_device({"readout.adc_bits=32", "noise.turn_on_deg_per_s=0"});
  const auto bias = [&](const std::string& motion) {
    const Recording run =
        simulate_quasistatic(scenario_from(motion), device, {});
    return column_values(run, "true_bias")[900];
  };
  EXPECT_NEAR(bias("[acceleration]\nx = { constant_g = 10 }\n") - bias(""),
              0.2 + 0.2, 0.01);
  const Recording run = simulate_quasistatic(
      scenario_from("[acceleration]\ny = { steps = [[0, 0], [50, -1]] }\n"),
      device, {});
  EXPECT_EQ(column_values(run, "true_acceleration_y")[499], 0);
  EXPECT_DOUBLE_EQ(column_values(run, "true_acceleration_y")[500], -kGravity);
  EXPECT_EQ(find_column(run, "true_acceleration_x"), nullptr);
}

std::string rejected(const std::string& extra) {
  try {
    scenario_from(extra);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ScenarioFile, NamesWhatIsWrongWithTheMotionOfAnAxis) {
  const auto says = [](const std::string& extra, const std::string& part) {
    EXPECT_NE(rejected(extra).find(part), std::string::npos) << rejected(extra);
  };
  says("[acceleration]\nx = { constant_g = 1, steps = [[0, 1]] }\n",
       "acceleration.x.steps: given beside constant_g");
  says("[acceleration]\nx = { constant_g = 2000 }\n", "[-1000, 1000]");
  says("[cross_rate]\ny = { sine = { frequency_Hz = 1 } }\n",
       "amplitude_deg_per_s");
  says("[cross_rate]\nx = { random = { rms_deg_per_s = 1 } }\n",
       "bandwidth_Hz");
  says("[cross_rate]\nz = { constant_deg_per_s = 1 }\n", "cross_rate.z");
}

}  // namespace
}  // namespace beamgyro
