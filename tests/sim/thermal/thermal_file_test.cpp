// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "config/document.h"
#include "sim/thermal/thermal_network.h"
#include "sim/thermal/thermal_parameters.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::thermal_file_test {
namespace {

constexpr char kOven[] =
    "[thermal.oven]\n"
    "set_point_degC = 65\n"
    "max_power_W = 3\n"
    "proportional_W_per_K = 1.0\n"
    "integral_time_s = 60\n";

std::string line(const std::string& key, double value) {
  return key + " = " + std::to_string(value) + "\n";
}

// A whole [thermal] table in which `key` stands as `text` ("" leaves it out).
std::string table_with(const std::string& key, const std::string& text) {
  const ThermalParameters nominal;
  std::string table = "[thermal]\n";
  for (const auto& field : thermal_fields()) {
    table += field.key == key ? text : line(field.key, nominal.*field.value);
  }
  return table;
}

ThermalParameters parsed(const std::string& text) {
  const ConfigDocument document = ConfigDocument::parse(text, "unit.toml");
  const ThermalParameters parameters =
      read_thermal(document.root().table("thermal"));
  document.reject_unknown_keys();
  return parameters;
}

std::string rejection_of(const std::string& text) {
  return rejection([&] { parsed(text); });
}

TEST(ThermalFile, ShippedUnitIsTheNominalOne) {
  const ConfigDocument document =
      ConfigDocument::read(BEAMGYRO_DEVICES "/nominal.toml");
  const ThermalParameters unit = read_thermal(document.root().table("thermal"));
  const ThermalParameters nominal;
  for (const auto& field : thermal_fields()) {
    EXPECT_EQ(unit.*field.value, nominal.*field.value) << field.key;
  }
  EXPECT_FALSE(unit.oven);
}

TEST(ThermalFile, EveryKeyReachesItsOwnField) {
  for (const auto& field : thermal_fields()) {
    const ThermalParameters unit =
        parsed(table_with(field.key, line(field.key, 0.75)));
    EXPECT_EQ(unit.*field.value, 0.75) << field.key;
  }
}

TEST(ThermalFile, EveryKeyIsRequired) {
  for (const auto& field : thermal_fields()) {
    const std::string message = rejection_of(table_with(field.key, ""));
    EXPECT_TRUE(holds(message, field.key));
  }
}

TEST(ThermalFile, RejectsANegativeNumberWithItsPlace) {
  const std::string message =
      rejection_of(table_with("housing_area_m2", "housing_area_m2 = -0.008\n"));
  EXPECT_TRUE(holds(message, "unit.toml:16:"));
  EXPECT_TRUE(holds(message, "housing_area_m2"));
  EXPECT_TRUE(holds(message, "-0.008"));
}

TEST(ThermalFile, RejectsANetworkThatFallsApart) {
  const std::string message = rejection_of(table_with(
      "beam_pzt_conductance_W_per_K", "beam_pzt_conductance_W_per_K = 0\n"));
  EXPECT_TRUE(holds(message, "joins the pzt to the beam"));
}

TEST(ThermalFile, ReadsAnOvenInKelvin) {
  const ThermalParameters unit = parsed(table_with("", "") + kOven);
  ASSERT_TRUE(unit.oven);
  EXPECT_DOUBLE_EQ(unit.oven->set_point, 338.15);
  EXPECT_EQ(unit.oven->max_power, 3.0);
  EXPECT_EQ(unit.oven->proportional_gain, 1.0);
  EXPECT_EQ(unit.oven->integral_time, 60.0);
}

TEST(ThermalFile, RejectsAnOvenAtATemperatureThatMaterialsDoNotStand) {
  std::string oven = kOven;
  oven.replace(oven.find("65"), 2, "160");
  const std::string message = rejection_of(table_with("", "") + oven);
  EXPECT_TRUE(holds(message, "set_point_degC"));
  EXPECT_TRUE(holds(message, "[-100, 150]"));
}

TEST(ThermalFile, RejectsAnUnknownKey) {
  const std::string message =
      rejection_of(table_with("", "") + "housing_aera_m2 = 1\n");
  EXPECT_TRUE(holds(message, "housing_aera_m2"));
}

}  // namespace
}  // namespace beamgyro::internal::thermal_file_test
