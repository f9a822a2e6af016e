// SPDX-License-Identifier: MIT
#include "dataset/recording/signals.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "dataset/recording/units.h"

namespace beamgyro::internal::signals_test {
namespace {

TEST(Signals, HaveNamesOfTheirOwnAndUnitsThatFilesMayState) {
  std::set<std::string_view> names;
  for (const RecordedSignal& one : recorded_signals()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_FALSE(one.long_name.empty()) << one.name;
    EXPECT_NO_THROW(unit_conversion(one.units, one.units)) << one.name;
    EXPECT_EQ(one.role == Role::kTruth, one.name.starts_with("true_"))
        << one.name;
  }
}

TEST(Signals, EveryVariableOfAFileHasAUnit) {
  EXPECT_EQ(unit_of_variable("time"), "s");
  EXPECT_EQ(unit_of_variable("status"), "1");
  EXPECT_EQ(unit_of_variable("output"), "V");
  EXPECT_EQ(unit_of_variable("quadrature"), "degree/s");
  EXPECT_EQ(unit_of_variable("true_beam_temperature"), "degC");
  EXPECT_EQ(unit_of_variable("true_acceleration_z"), "m/s2");
  EXPECT_EQ(unit_of_variable("true_cross_rate_x"), "degree/s");
  EXPECT_EQ(unit_of_variable("compensated_rate"), "degree/s");
  EXPECT_EQ(unit_of_variable("humidity"), "");
}

TEST(Signals, AColumnIsDescribedByTheTable) {
  const Column column = column_of("true_rate", {1.0, 2.0});
  EXPECT_EQ(column.name, "true_rate");
  EXPECT_EQ(column.units, "degree/s");
  EXPECT_EQ(column.long_name, "rate about the input axis");
  EXPECT_EQ(column.role, Role::kTruth);
  EXPECT_EQ(column.values, (std::vector{1.0, 2.0}));
  EXPECT_THROW(column_of("humidity", {}), std::logic_error);
}

}  // namespace
}  // namespace beamgyro::internal::signals_test
