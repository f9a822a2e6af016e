// SPDX-License-Identifier: MIT
#include "sim/signal/temperature_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/config/rejection.h"

namespace beamgyro::internal::temperature_sensor_test {
namespace {

constexpr TemperatureSensorParameters kSensor = {
    .noise = 0.01, .resolution = 0.05, .offset = 0.3};

TEST(TemperatureSensor, WithNoiseOffKeepsItsOffsetAndItsCelsiusScale) {
  TemperatureSensorParameters silent = kSensor;
  silent.noise = 10.0;  // would show in every reading
  const std::vector<double> temperature = {298.15, 298.17, 298.18, 243.16};
  const auto reading =
      TemperatureSensor(silent, false, 1, 0, 0).readings(temperature);
  EXPECT_DOUBLE_EQ(reading[0], 25.30);
  EXPECT_DOUBLE_EQ(reading[1], 25.30);
  EXPECT_DOUBLE_EQ(reading[2], 25.35);
  EXPECT_DOUBLE_EQ(reading[3], -29.70);
}

TEST(TemperatureSensor, IdealOneShowsTheTemperature) {
  const std::vector<double> temperature = {300.0, 233.333};
  const auto reading =
      TemperatureSensor({}, true, 1, 0, 0).readings(temperature);
  EXPECT_EQ(reading[0], 300.0 - 273.15);
  EXPECT_EQ(reading[1], 233.333 - 273.15);
}

TEST(TemperatureSensor, NoiseIsWhiteWithItsSigma) {
  constexpr std::size_t kCount = 200000;
  const std::vector<double> temperature(kCount, 298.15);
  const auto reading =
      TemperatureSensor({.noise = 0.01}, true, 1, 0, 0).readings(temperature);
  double variance = 0.0, next = 0.0;
  for (std::size_t i = 0; i + 1 < kCount; ++i) {
    variance += std::pow(reading[i] - 25.0, 2) / kCount;
    next += (reading[i] - 25.0) * (reading[i + 1] - 25.0) / kCount;
  }
  const double sigma = std::sqrt(1.0 / kCount);
  EXPECT_NEAR(variance / 1e-4, 1.0, 3.0 * std::sqrt(2.0) * sigma);
  EXPECT_NEAR(next / 1e-4, 0.0, 3.0 * sigma);
}

TEST(TemperatureSensor, ReadingsWithNoiseAreMultiplesOfTheResolution) {
  const std::vector<double> temperature(1000, 298.16);
  int changes = 0;
  for (double reading :
       TemperatureSensor(kSensor, true, 1, 0, 0).readings(temperature)) {
    EXPECT_NEAR(std::remainder(reading, 0.05), 0.0, 1e-12);
    changes += std::abs(reading - 25.30) > 0.01 ? 1 : 0;
  }
  EXPECT_GT(changes, 0);  // 25.325 is 1.5 sigma away
}

TEST(TemperatureSensor, EveryRunHasItsOwnNoise) {
  const std::vector<double> temperature(100, 298.15);
  const TemperatureSensorParameters noisy = {.noise = 0.01};
  const auto first =
      TemperatureSensor(noisy, true, 1, 0, 0).readings(temperature);
  EXPECT_EQ(first,
            TemperatureSensor(noisy, true, 1, 0, 0).readings(temperature));
  EXPECT_NE(first,
            TemperatureSensor(noisy, true, 1, 0, 1).readings(temperature));
  EXPECT_NE(first,
            TemperatureSensor(noisy, true, 1, 1, 0).readings(temperature));
  EXPECT_NE(first,
            TemperatureSensor(noisy, true, 2, 0, 0).readings(temperature));
}

std::string rejection_of(const TemperatureSensorParameters& parameters) {
  const std::vector<double> temperature = {300.0};
  return rejection([&] {
    TemperatureSensor(parameters, true, 0, 0, 0).readings(temperature);
  });
}

TEST(TemperatureSensor, RejectsBadParameters) {
  EXPECT_EQ(rejection_of({.noise = -1.0}),
            "temperature sensor noise is -1 K, must be 0 or more");
  EXPECT_EQ(rejection_of({.resolution = -1.0}),
            "resolution is -1, must be 0 or more");
  EXPECT_EQ(rejection_of({.offset = NAN}),
            "temperature sensor offset is nan K, must be finite");
}

}  // namespace
}  // namespace beamgyro::internal::temperature_sensor_test
