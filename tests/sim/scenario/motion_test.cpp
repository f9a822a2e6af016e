// SPDX-License-Identifier: MIT
#include "sim/scenario/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::motion_test {
namespace {

const TrimmedGyro& nominal_gyro() {
  static const TrimmedGyro gyro = make_gyro(nominal_device());
  return gyro;
}

std::vector<Piece> pieces(const ScenarioPlan& scenario, const Motion& motion) {
  return pieces_until(scenario.duration, motion.borders());
}

std::vector<double> ends(const std::vector<Piece>& pieces) {
  std::vector<double> ends;
  for (const Piece& piece : pieces) ends.push_back(piece.end);
  return ends;
}

TEST(Motion, HasItsLimitsOnBothSidesOfAStep) {
  const ScenarioPlan scenario =
      scenario_from("[rate]\nsteps = [[0, 1], [10, 3]]\n");
  const Motion motion(scenario, nominal_gyro(), {});
  EXPECT_EQ(ends(pieces(scenario, motion)), (std::vector<double>{10, 100}));
  EXPECT_TRUE(pieces(scenario, motion)[1].jump);
  EXPECT_FALSE(motion.rate_is_zero());
  EXPECT_DOUBLE_EQ(motion.segment(0, 10).at(10).z, 1 * kDegree);
  EXPECT_DOUBLE_EQ(motion.segment(10, 100).at(10).z, 3 * kDegree);
  EXPECT_EQ(motion.segment(10, 100).at_rest(20).z, 0);
  EXPECT_TRUE(motion.segment(10, 100).is_constant());
}

TEST(Motion, OfPointsBendsAndHasTheirSlope) {
  const ScenarioPlan scenario =
      scenario_from("[rate]\npoints = [[0, 0], [10, 20], [20, 0]]\n");
  const Motion motion(scenario, nominal_gyro(), {});
  EXPECT_EQ(ends(pieces(scenario, motion)), (std::vector<double>{10, 20, 100}));
  EXPECT_FALSE(pieces(scenario, motion)[1].jump);
  const CaseMotion up = motion.segment(0, 10).at(5);
  EXPECT_NEAR(up.z, 10 * kDegree, 1e-15);
  EXPECT_NEAR(up.z_acceleration, 2 * kDegree, 1e-15);
  EXPECT_NEAR(motion.segment(10, 20).at(12).z_acceleration, -2 * kDegree,
              1e-15);
  EXPECT_FALSE(motion.segment(0, 10).is_constant());
}

TEST(Motion, OfEveryAxisTogether) {
  const ScenarioPlan scenario = scenario_from(
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

TEST(Motion, BreaksWhereAnyAxisDoes) {
  const ScenarioPlan scenario = scenario_from(
      "[rate]\npoints = [[0, 0], [30, 3], [60, 0]]\n"
      "[cross_rate]\ny = { points = [[30, 0], [40, 5], [200, 0]] }\n"
      "[acceleration]\nx = { steps = [[0, 0], [20, 2], [100, 1]] }\n"
      "z = { sine = { amplitude_g = 1, frequency_Hz = 2 } }\n");
  const Motion motion(scenario, nominal_gyro(), {});
  const std::vector<Piece> all = pieces(scenario, motion);
  EXPECT_EQ(ends(all), (std::vector<double>{20, 30, 40, 60, 100}));
  for (const Piece& piece : all)
    EXPECT_EQ(piece.jump, piece.start == 20) << piece.start;
}

TEST(Motion, OfAccelerationJumpsAtAStepOnly) {
  const ScenarioPlan scenario =
      scenario_from("[acceleration]\nx = { steps = [[0, 0], [20, 2]] }\n");
  const Motion motion(scenario, nominal_gyro(), {});
  EXPECT_TRUE(motion.rate_is_zero());
  EXPECT_EQ(motion.segment(0, 20).at(20).in_phase, 0);
  EXPECT_NEAR(motion.segment(20, 100).at(20).in_phase / kDegree,
              0.02 * 2 + 0.002 * 4, 1e-12);
  EXPECT_TRUE(motion.segment(0, 20).is_constant());
}

TEST(Motion, OfTheTwinKeepsAllButTheRateAboutZ) {
  const ScenarioPlan scenario = scenario_from(
      "[rate]\nsine = { amplitude_deg_per_s = 2, frequency_Hz = 0.5, "
      "phase_rad = 0.3, offset_deg_per_s = 1 }\n"
      "[cross_rate]\nx = { sine = { amplitude_deg_per_s = 3, frequency_Hz = "
      "0.1 } }\n[acceleration]\ny = { constant_g = -1 }\n");
  const Motion motion(scenario, nominal_gyro(), {});
  const MotionSegment segment = motion.segment(0, 100);
  const CaseMotion moving = segment.at(33.3), resting = segment.at_rest(33.3);
  EXPECT_NEAR(moving.z,
              (1 + 2 * std::sin(std::numbers::pi * 33.3 + 0.3)) * kDegree,
              1e-14);
  EXPECT_EQ(resting.z, 0);
  EXPECT_EQ(resting.z_acceleration, 0);
  EXPECT_EQ(resting.x, moving.x);
  EXPECT_NEAR(resting.x, 3 * std::sin(0.2 * std::numbers::pi * 33.3) * kDegree,
              1e-14);
  EXPECT_EQ(resting.in_phase, moving.in_phase);
  EXPECT_NEAR(resting.in_phase / kDegree, -0.02 + 0.002, 1e-12);
}

TEST(Motion, OfASegmentMeetsTheSamplesOfTheRun) {
  const ScenarioPlan scenario = scenario_from(
      "[rate.random]\nrms_deg_per_s = 5\nbandwidth_Hz = 0.5\n"
      "[cross_rate]\ny = { points = [[0, 0], [33, 10], [50, -4]] }\n");
  const Motion motion(scenario, nominal_gyro(), {});
  RunSamples samples;
  samples.time = sample_times(scenario);
  motion.sample(samples);
  std::size_t k = 0;
  for (const Piece& piece : pieces(scenario, motion)) {
    const MotionSegment segment = motion.segment(piece.start, piece.end);
    for (; k < samples.time.size() && samples.time[k] < piece.end; ++k) {
      EXPECT_NEAR(segment.at(samples.time[k]).z, samples.motion[kRateZ][k],
                  1e-14);
      EXPECT_NEAR(segment.at(samples.time[k]).y, samples.motion[kRateY][k],
                  1e-14);
    }
  }
  EXPECT_EQ(k, samples.time.size());
}

std::string rejected(const std::string& extra) {
  return rejection([&] { scenario_from(extra); });
}

TEST(ScenarioFile, NamesWhatIsWrongWithTheMotionOfAnAxis) {
  const auto says = [](const std::string& extra, const std::string& part) {
    EXPECT_TRUE(holds(rejected(extra), part));
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
}  // namespace beamgyro::internal::motion_test
