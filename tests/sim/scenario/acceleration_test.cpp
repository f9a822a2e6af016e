// SPDX-License-Identifier: MIT
// What accelerations do to the output of a quasi-static run (2.1):
// b_g . a + r |a|^2, b_g = (0.02, 0.02, 0.005) deg/s/g, r = 0.002 deg/s/g^2.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "sim/scenario/simulation.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::acceleration_test {
namespace {

constexpr double kRectification = 0.002;  // [deg/s/g^2]

// Change of the zero-rate output by a motion, sample by sample [deg/s], of a
// unit that stays at the temperature of its trims.
std::vector<double> bias_change(const std::string& motion,
                                const std::string& duration = "20",
                                const std::string& rate = "20") {
  const DeviceParameters device =
      nominal_device({"thermal.electronics_power_W=0.0"});
  const auto bias = [&](const std::string& text) {
    return column_values(
        simulated(scenario_from(text, "[ambient]\nconstant_degC = 25\n",
                                duration, rate),
                  device),
        "true_bias");
  };
  std::vector<double> change = bias(motion);
  const std::vector<double> still = bias("");
  for (std::size_t k = 0; k < change.size(); ++k) change[k] -= still[k];
  return change;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

TEST(Acceleration, ShiftsTheBiasByItsAxisSensitivityAndItsSquare) {
  const std::pair<const char*, double> axes[] = {
      {"x", 0.02}, {"y", 0.02}, {"z", 0.005}};
  for (const auto& [axis, sensitivity] : axes) {
    const std::string table =
        std::string("[acceleration]\n") + axis + " = { constant_g = ";
    const double up = bias_change(table + "4 }\n").back();
    const double down = bias_change(table + "-4 }\n").back();
    EXPECT_NEAR((up - down) / 2 / (4 * sensitivity), 1, 0.01) << axis;
    EXPECT_NEAR((up + down) / 2 / (16 * kRectification), 1, 0.01) << axis;
  }
}

TEST(Acceleration, OfSeveralAxesAddsUp) {
  const double found =
      bias_change(
          "[acceleration]\nx = { constant_g = 3 }\ny = { constant_g = -2 }\n"
          "z = { constant_g = 6 }\n")
          .back();
  const double expected =
      0.02 * 3 - 0.02 * 2 + 0.005 * 6 + kRectification * (9 + 4 + 36);
  EXPECT_NEAR(found / expected, 1, 0.01);
}

TEST(Acceleration, SlowSineShowsInTheBiasAtEveryInstant) {
  const std::vector<double> change = bias_change(
      "[acceleration.x.sine]\namplitude_g = 5\nfrequency_Hz = 0.05\n"
      "offset_g = 1\nphase_rad = 0.7\n");
  // The output filter delays by 2/w_o = 5.3 ms.
  for (std::size_t k = 0; k < change.size(); ++k) {
    const double t = static_cast<double>(k) / 20 - 2 / (120 * std::numbers::pi);
    const double a = 1 + 5 * std::sin(0.1 * std::numbers::pi * t + 0.7);
    EXPECT_NEAR(change[k], 0.02 * a + kRectification * a * a, 2e-3) << t;
  }
}

// A 1 g offset and a vibration far above the output filter's 60 Hz: the filter
// takes out the vibration, not its mean square.
TEST(Acceleration, FastSineIsRectified) {
  const std::vector<double> change = bias_change(
      "[acceleration.x.sine]\namplitude_g = 5\nfrequency_Hz = 497.3\n"
      "offset_g = 1\n",
      "50");
  EXPECT_NEAR(mean(change) / (0.02 + kRectification * (1 + 12.5)), 1, 0.02);
}

TEST(Acceleration, FastRandomVibrationIsRectified) {
  const std::vector<double> change = bias_change(
      "[acceleration.x.random]\nrms_g = 10\nbandwidth_Hz = 200\n", "100");
  EXPECT_NEAR(mean(change) / (kRectification * 100), 1, 0.05);
}

TEST(Acceleration, RecordedVibrationIsRectified) {
  // 8 g, up and down in turn every millisecond: a mean square of 64/3 g^2.
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "vibration.csv";
  std::ofstream file(path);
  file << "time_s,acceleration_g\n";
  for (int k = 0; k <= 10000; ++k)
    file << k * 1e-3 << ',' << (k % 2 == 0 ? 8 : -8) << '\n';
  file.close();
  const std::vector<double> change =
      bias_change("[acceleration.z]\nfile = \"" + path.string() + "\"\n", "10");
  EXPECT_NEAR(mean(change) / (kRectification * 64 / 3), 1, 0.02);
  std::filesystem::remove(path);
}

TEST(Acceleration, IsTheSameInTheTwinAndUnderARate) {
  const std::string acceleration = "[acceleration]\ny = { constant_g = 6 }\n";
  const double alone = bias_change(acceleration).back();
  const double turning =
      bias_change(acceleration + "[rate]\nconstant_deg_per_s = 50\n").back();
#ifdef BEAMGYRO_SANITIZED  // by a compiler that sums in another order
  EXPECT_NEAR(turning, alone, 4 * 50 * std::numeric_limits<double>::epsilon());
#else
  EXPECT_EQ(turning, alone);
#endif
}

TEST(CrossRate, ShowsInTheQuadratureOfARun) {
  const auto quadrature = [](const std::string& text) {
    return column_values(
               simulated(scenario_from("[noise]\nenabled = false\n" + text),
                         nominal_device(
                             {"thermal.electronics_power_W=0.0",
                              "readout.quadrature_resolution_deg_per_s=1e-9"})),
               "quadrature")
        .back();
  };
  const auto about = [&](double x, double y) {
    return quadrature(
        "[cross_rate]\nx = { constant_deg_per_s = " + std::to_string(x) +
        " }\ny = { constant_deg_per_s = " + std::to_string(y) + " }\n");
  };
  // Half the difference of both signs leaves Ox Oy / (2 w) alone.
  const double found = (about(300, 300) - about(300, -300)) / 2;
  const double w = 2 * std::numbers::pi * 9081.5;
  EXPECT_NEAR(found / (300 * 300 * kDegree / (2 * w)), 1, 0.05);
}

}  // namespace
}  // namespace beamgyro::internal::acceleration_test
