// SPDX-License-Identifier: MIT
#include "dataset/log/log_map.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::log_map_test {
namespace {

const std::string kMap =
    "powered_s = 5\n[time]\ncolumn = \"t\"\nunit = \"ms\"\n" +
    gyro_and_temperature();

std::string changed(const std::string& from, const std::string& to) {
  const std::size_t at = kMap.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return std::string(kMap).replace(at, from.size(), to);
}

LogMap map_of(const std::string& text, const std::string& axis = "") {
  return read_log_map(ConfigDocument::parse(text, "map.toml"), axis);
}

std::string rejection_of(const std::string& text,
                         const std::string& axis = "") {
  return rejection([&] { map_of(text, axis); });
}

const LogQuantity& quantity(const LogMap& map, std::string_view variable) {
  for (const LogQuantity& quantity : map.quantities)
    if (quantity.signal.name == variable) return quantity;
  ADD_FAILURE() << variable;
  return map.quantities.front();
}

double rate(const std::string& keys, double raw) {
  return quantity(map_of(changed("unit = \"deg/s\"", keys)), "rate").value(raw);
}

double temperature(const std::string& keys, double raw) {
  return quantity(map_of(changed("unit = \"degC\"", keys)), "temperature")
      .value(raw);
}

TEST(LogMap, RatesBecomeDegreesPerSecond) {
  EXPECT_EQ(rate("unit = \"deg/s\"", -12.5), -12.5);
  EXPECT_EQ(rate("unit = \"deg/s\"\noffset = 0.5", 3.0), 2.5);
  EXPECT_DOUBLE_EQ(rate("unit = \"rad/s\"", std::numbers::pi / 6), 30.0);
  EXPECT_DOUBLE_EQ(
      rate("unit = \"V\"\noffset = 2.5\nscale_deg_per_s = 80", 2.5125),
      80 * (2.5125 - 2.5));
  EXPECT_EQ(rate("unit = \"counts\"\noffset = 16\nscale_deg_per_s = -0.25", 20),
            -1.0);
}

TEST(LogMap, TemperaturesBecomeDegreesCelsius) {
  EXPECT_EQ(temperature("unit = \"degC\"", 25), 25.0);
  EXPECT_DOUBLE_EQ(temperature("unit = \"degF\"", 212), 100.0);
  EXPECT_DOUBLE_EQ(temperature("unit = \"degF\"", -40), -40.0);
  EXPECT_DOUBLE_EQ(temperature("unit = \"K\"", 298.15), 25.0);
  EXPECT_EQ(
      temperature("unit = \"counts\"\nscale_K = 0.5\noffset_degC = 25", -60),
      -5.0);
}

TEST(LogMap, CountsAreReadAsTwosComplement) {
  const std::string wrapped =
      "unit = \"counts\"\nwrap_bits = 16\nscale_K = 1\n"
      "offset_degC = 0";
  EXPECT_EQ(temperature(wrapped, 65236), -300.0);
  EXPECT_EQ(temperature(wrapped, 32767), 32767.0);
  EXPECT_EQ(temperature(wrapped, 32768), -32768.0);
  EXPECT_EQ(temperature(wrapped, 65535), -1.0);
  EXPECT_EQ(
      rate("unit = \"counts\"\nwrap_bits = 12\nscale_deg_per_s = 2", 4095),
      -2.0);
  const LogMap map = map_of(changed("unit = \"degC\"", wrapped));
  for (const double fit : {0.0, 65535.0})
    EXPECT_TRUE(quantity(map, "temperature").fits(fit));
  for (const double unfit : {-1.0, 65536.0, 0.5})
    EXPECT_FALSE(quantity(map, "temperature").fits(unfit));
}

TEST(LogMap, TheOtherVariablesHaveUnits) {
  const LogMap map = map_of(kMap + R"(
[drive_frequency]
column = "f"
unit = "kHz"
[drive_voltage]
column = "v"
unit = "mV"
[quadrature]
column = "q"
unit = "rad/s"
[true_rate]
column = "r"
unit = "deg/s"
)");
  EXPECT_DOUBLE_EQ(quantity(map, "drive_frequency").value(7.5), 7500.0);
  EXPECT_DOUBLE_EQ(quantity(map, "drive_voltage").value(812), 0.812);
  EXPECT_DOUBLE_EQ(quantity(map, "quadrature").value(std::numbers::pi), 180.0);
  EXPECT_EQ(quantity(map, "true_rate").signal.role, Role::kTruth);
  EXPECT_FALSE(map.constant_true_rate);
  EXPECT_EQ(quantity(map, "rate").signal.role, Role::kMeasured);
}

TEST(LogMap, OutputComesWithVolts) {
  const LogMap map =
      map_of(changed("unit = \"deg/s\"", "unit = \"V\"\nscale_deg_per_s = 80"));
  ASSERT_EQ(map.quantities.size(), 3u);
  EXPECT_EQ(map.quantities[0].signal.name, "output");
  EXPECT_EQ(map.quantities[0].signal.units, "V");
  EXPECT_EQ(map.quantities[0].value(2.5), 2.5);
}

TEST(LogMap, DefaultsAreThoseOfTheDocument) {
  const LogMap map = map_of(changed("powered_s = 5\n", ""));
  EXPECT_EQ(map.layout.delimiter, 0);
  EXPECT_TRUE(map.layout.header);
  EXPECT_TRUE(map.layout.comment_prefixes.empty());
  EXPECT_TRUE(map.missing_markers.empty());
  EXPECT_FALSE(map.filter || map.status || map.constant_true_rate);
  EXPECT_FALSE(map.time.offset);
  EXPECT_EQ(map.time.ticks_per_s, 1e3);
  EXPECT_TRUE(map.powered.empty());
  EXPECT_FALSE(map.rules.drop_ragged || map.rules.drop_backward);
  EXPECT_TRUE(map.rules.drop_missing && map.rules.drop_duplicates);
  EXPECT_FALSE(map.rules.outliers);
  const LogMap with = map_of(kMap + "[rules.outliers]\n");
  EXPECT_EQ(with.rules.outliers->window, 25u);
  EXPECT_EQ(with.rules.outliers->k, 20.0);
}

TEST(LogMap, StatusBits) {
  const LogMap map = map_of(kMap + R"([status]
column = 4
unpowered = [1, 9]
saturated = [2, 9]
valid = [0]
)");
  EXPECT_EQ(map.status->column.number, 4u);
  EXPECT_EQ(map.status->bits(0), 0);
  EXPECT_EQ(map.status->bits(1), kUnpowered);
  EXPECT_EQ(map.status->bits(2), kOutputSaturated);
  EXPECT_EQ(map.status->bits(9), kUnpowered | kOutputSaturated);
  EXPECT_EQ(map.status->bits(7), kLoopNotLocked);
  const LogMap open = map_of(kMap + "[status]\ncolumn = 4\nnot_locked = [3]\n");
  EXPECT_EQ(open.status->bits(7), 0);
  EXPECT_EQ(open.status->bits(3), kLoopNotLocked);
}

TEST(LogMap, TrueRateForms) {
  EXPECT_EQ(map_of(kMap + "[true_rate]\nat_rest = true\n").constant_true_rate,
            0.0);
  EXPECT_EQ(map_of(kMap + "[true_rate]\nconstant_deg_per_s = -10\n")
                .constant_true_rate,
            -10.0);
  EXPECT_FALSE(
      map_of(kMap + "[true_rate]\nat_rest = false\n").constant_true_rate);
  EXPECT_TRUE(holds(rejection_of(kMap + "[true_rate]\nat_rest = true\n"
                                        "constant_deg_per_s = 1\n"),
                    "at_rest: not used together"));
}

TEST(LogMap, AxesAreChosenAndAllAreRead) {
  const std::string axes = changed("[gyro]\ncolumn = \"w\"\nunit = \"deg/s\"\n",
                                   "[gyro.x]\ncolumn = \"p\"\nunit = "
                                   "\"deg/s\"\n[gyro.z]\ncolumn = \"r\"\nunit "
                                   "= \"rad/s\"\n");
  EXPECT_EQ(quantity(map_of(axes, "x"), "rate").column.name, "p");
  EXPECT_EQ(quantity(map_of(axes, "z"), "rate").column.name, "r");
  EXPECT_EQ(rejection_of(axes),
            "map.toml:5:1: gyro: has the axes x, z; expected axis to choose "
            "one");
  EXPECT_EQ(rejection_of(axes, "y"),
            "axis = y: map.toml:5:1: gyro: has no such axis; expected one of "
            "x, z");
  EXPECT_EQ(rejection_of(kMap, "z"),
            "axis = z: map.toml:5:1: gyro: has no axes; expected no axis");
}

void refused(const std::string& text, const std::string& why) {
  EXPECT_TRUE(holds(rejection_of(text), why));
}

TEST(LogMap, UnitsAreNeverGuessed) {
  refused(changed("unit = \"deg/s\"\n", ""),
          "gyro.unit: missing; expected one of \"deg/s\"");
  refused(changed("unit = \"degC\"\n", ""), "temperature.unit: missing");
  refused(changed("unit = \"ms\"\n", ""), "time.unit: missing");
  refused(changed("\"degC\"", "\"C\""), "temperature.unit: \"C\" is not known");
  for (const char* unit : {"V", "counts"})
    refused(changed("deg/s", unit), "gyro.scale_deg_per_s: missing");
  refused(changed("\"degC\"", "\"counts\"\nscale_K = 1"),
          "temperature.offset_degC: missing");
}

TEST(LogMap, RefusesKeysThatMeanNothing) {
  refused(changed("\"deg/s\"", "\"rad/s\"\nscale_deg_per_s = 2"),
          "gyro.scale_deg_per_s: not used together");
  refused(changed("\"degC\"", "\"degC\"\nwrap_bits = 16"),
          "temperature.wrap_bits: not used together");
  refused(changed("\"degC\"", "\"counts\"\nscale_K = 0\noffset_degC = 0"),
          "temperature.scale_K: 0 is out of range");
  refused(changed("\"ms\"", "\"ms\"\nrate_Hz = 10"),
          "time.rate_Hz: not used together");
  refused(changed("\"ms\"", "\"index\""), "time.rate_Hz: missing");
  refused(changed("column = \"t\"\n", ""), "time.rate_Hz: missing");
  refused(changed("\"t\"", "0"), "time.column: 0 is out of range");
  refused(changed("\"t\"", "\"\""), "time.column: \"\" is no name");
  refused(changed("powered_s = 5", "powered_s = [[0, 5], [4, 9]]"),
          "powered_s[1]: [4, 9] is out of order");
  refused(changed("powered_s = 5", "powered_s = []"), "powered_s: an array");
  refused(changed("powered_s", "powerd_s"), "did you mean 'powered_s'?");
  refused(kMap + "[rules]\nbackward = \"keep\"\n", "rules.backward: \"keep\"");
  refused(kMap + "[rules.outliers]\nwindow = 10\n", "10 is even");
  refused(kMap + "[status]\ncolumn = 4\n", "status.valid: missing");
  refused("comment_prefixes = [\"\"]\n" + kMap, "comment_prefixes: \"\"");
  refused("delimiter = \"#\"\n" + kMap, "delimiter: \"#\" is not known");
  refused(changed("\"ms\"", "\"ms\"\nformat = \"iso\""),
          "time.unit: not used together");
  refused(changed("unit = \"ms\"", "format = \"%d.%m\""),
          "time.format: \"%d.%m\": is no form of a date or time");
  refused(changed("\"ms\"", "\"ms\"\ndate_column = \"d\""),
          "time.date_column: not used together");
  refused("header = false\nheader_line = 2\n" + kMap,
          "header_line: not used together");
}

}  // namespace
}  // namespace beamgyro::internal::log_map_test
