// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "compensation/export/export_findings.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::firmware_difference_test {
namespace {

// A network whose output weights are `weight` and -weight in turn.
FittedCompensator with_output_weights(double weight) {
  FittedCompensator c = network_compensator();
  auto& network = std::get<BpNetwork>(c.bias.function);
  Eigen::VectorXd w = network.weights();
  const Eigen::Index last = w.size() - 5;  // weights of four neurons, bias
  for (Eigen::Index k = 0; k < 4; ++k)
    w(last + k) = k % 2 == 0 ? weight : -weight;
  network.set_weights(w);
  return c;
}

FittedCompensator of_input(const std::string& name, const Scale& scale,
                           double slope) {
  FittedCompensator c;
  c.inputs = {parse_input(name)};
  c.bias = {{scale}, {}, Polynomial{{0.0, slope}}};
  c.baseline = {{Scale{}}, {}, Polynomial{{0.0}}};
  c.temperature_range = {.lowest = -40.0, .highest = 50.0};
  return c;
}

TEST(FirmwareDifference, EveryKindIsWithinHalfOfTheLimit) {
  // Of rates of 150 deg/s alone a single holds 7.6e-6.
  for (const NamedCompensator& each : one_of_each_kind()) {
    const double difference = firmware_difference(each.compensator).rate;
    EXPECT_GT(difference, 5e-6) << each.name;
    EXPECT_LT(difference, 5e-5) << each.name;
  }
}

TEST(FirmwareDifference, GrowsWithTheWeightsOfANetwork) {
  const double of_100 = firmware_difference(with_output_weights(100.0)).rate;
  EXPECT_GT(of_100, 1e-4);
  EXPECT_GT(firmware_difference(with_output_weights(1000.0)).rate,
            3.0 * of_100);
}

// What is left of an input near 9156 Hz when its change is all that a single
// holds: 1e-6 of 12 Hz; of the frequency itself it would be 5e-4 Hz.
TEST(FirmwareDifference, InputsAreMetWhereTrainingSawThem) {
  const double slope = 12.0 * 2.0;  // 2 deg/s/Hz
  EXPECT_LT(
      firmware_difference(of_input("drive_frequency", {9156.0, 12.0}, slope))
          .rate,
      2e-5);
  EXPECT_GT(firmware_difference(of_input("output", {9156.0, 12.0}, slope)).rate,
            5e-4);
}

// A slope of 2000 deg/s per K/s: of the lag of 60 s a single holds 4e-6 K.
TEST(FirmwareDifference, FiltersAreMetOnTheRampsOfTraining) {
  const double difference =
      firmware_difference(
          of_input("temperature_rate(60)", {0.0, 0.05}, 2000.0 * 0.05))
          .rate;
  EXPECT_GT(difference, 5e-5);
  EXPECT_LT(difference, 5e-4);
}

TEST(FirmwareDifference, SignalsWhoseRangeTheFileDoesNotTellAreRefused) {
  EXPECT_TRUE(holds(rejection([&] {
                      firmware_difference(of_input("drive_frequency", {}, 1.0));
                    }),
                    "the range of drive_frequency in training"));
}

TEST(FirmwareDifference, AnswersThatAreNotFiniteInSingleAreRefused) {
  EXPECT_TRUE(
      holds(rejection([&] {
              FittedCompensator c = of_input("temperature", {5.0, 45.0}, 3e38);
              c.bias.bias_scale.half_width = 3e38;
              firmware_difference(c);
            }),
            "not finite in single precision"));
}

}  // namespace
}  // namespace beamgyro::internal::firmware_difference_test
