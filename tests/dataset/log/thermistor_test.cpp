// SPDX-License-Identifier: MIT
#include "dataset/log/thermistor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::thermistor_test {
namespace {

std::string map_with(const std::string& temperature) {
  return "[time]\ncolumn = \"t\"\nunit = \"s\"\n[gyro]\ncolumn = \"w\"\n"
         "unit = \"deg/s\"\n[temperature]\ncolumn = \"T\"\n" +
         temperature;
}

const std::string kBeta =
    "[temperature.thermistor]\nbeta_K = 3950\nresistance_25_ohm = 10000\n";
const std::string kDivider = kBeta +
                             "series_ohm = 10000\nfull_scale = 1023\n"
                             "side = \"ground\"\n";

double temperature_of(const std::string& temperature,
                      const std::string& reading) {
  const ImportedLog log =
      imported(map_with(temperature),
               "t,w,T\n0,1," + reading + "\n1,1," + reading + "\n");
  return column_values(log.recording, "temperature").front();
}

TEST(Thermistor, BetaIsTheSlopeOfTheLogarithmAt25) {
  const std::string ohm = "unit = \"ohm\"\n" + kBeta;
  EXPECT_NEAR(temperature_of(ohm, "10000"), 25, 1e-9);
  EXPECT_NEAR(temperature_of("unit = \"kohm\"\n" + kBeta, "10"), 25, 1e-9);
  // R = R25 exp(B (1/T - 1/T25)), at 60 degC.
  const double r = 1e4 * std::exp(3950 * (1 / 333.15 - 1 / 298.15));
  EXPECT_NEAR(temperature_of(ohm, fmt::format("{}", r)), 60, 1e-9);
}

TEST(Thermistor, SteinhartAndHartWithThreeCoefficients) {
  // A thermistor of 10 kohm by its maker's resistances: 32650.8 ohm at 0 degC,
  // 10000 at 25, 3602.3 at 50, rounded to 0.1 ohm.
  const std::string three =
      "unit = \"ohm\"\n[temperature.thermistor]\n"
      "steinhart_hart = [1.129241e-3, 2.341077e-4, 8.775468e-8]\n";
  EXPECT_NEAR(temperature_of(three, "10000"), 25, 0.02);
  EXPECT_NEAR(temperature_of(three, "32650.8"), 0, 0.02);
  EXPECT_NEAR(temperature_of(three, "3602.3"), 50, 0.05);
}

TEST(Thermistor, EitherSideOfADividerReadsTheSameResistance) {
  const VoltageDivider ground{2e4, 3.3, true}, supply{2e4, 3.3, false};
  EXPECT_DOUBLE_EQ(ground.resistance(1.1), 1e4);  // 3.3 x 10 / (10 + 20)
  EXPECT_DOUBLE_EQ(supply.resistance(2.2), 1e4);
  for (const double end : {0.0, 3.3, -1.0, 4.0}) {
    EXPECT_TRUE(std::isnan(ground.resistance(end)));
    EXPECT_TRUE(std::isnan(supply.resistance(end)));
  }
  EXPECT_NEAR(temperature_of("unit = \"counts\"\n" + kDivider, "511.5"), 25,
              1e-9);
}

TEST(Thermistor, AnOpenOrShortOneIsNamed) {
  const std::string map = map_with("unit = \"counts\"\n" + kDivider);
  for (const char* reading : {"0", "1023"}) {
    const std::string message = rejection(
        [&] { imported(map, fmt::format("t,w,T\n0,1,{}\n", reading)); });
    EXPECT_TRUE(holds(message, "log.csv:2:5: '" + std::string(reading)));
    EXPECT_TRUE(holds(message, "between 0 and full_scale = 1023"));
  }
}

TEST(Thermistor, KeysThatAreMissingOrTooMany) {
  const auto refusal = [](const std::string& temperature) {
    return rejection(
        [&] { imported(map_with(temperature), "t,w,T\n0,1,500\n"); });
  };
  EXPECT_TRUE(holds(refusal("unit = \"ohm\"\n"), "thermistor: missing"));
  EXPECT_TRUE(holds(refusal("unit = \"counts\"\n" + kBeta), "series_ohm"));
  EXPECT_TRUE(
      holds(refusal("unit = \"ohm\"\n" + kDivider), "series_ohm: unknown key"));
  EXPECT_TRUE(holds(refusal("unit = \"degC\"\n" + kBeta), "thermistor"));
  EXPECT_TRUE(holds(
      refusal("unit = \"ohm\"\n[temperature.thermistor]\nsteinhart_hart = "
              "[1e-3, 0, 0]\n"),
      "the second number is not above 0"));
}

}  // namespace
}  // namespace beamgyro::internal::thermistor_test
