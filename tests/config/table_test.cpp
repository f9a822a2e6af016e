// SPDX-License-Identifier: MIT
#include "config/table.h"

#include <gtest/gtest.h>

#include <functional>

#include "config/document.h"
#include "config/document_state.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::table_test {
namespace {

constexpr const char* kDevice = R"(name = "unit 7"

[beam]
length_m = 0.04
count = 12
tip = -0.04
trimmed = true
offset_m = [14e-6, -5e-6, 8, 0.0]
points = [[0, 25], [10.5, -40.0]]
inputs = ["temperature", "output"]
sizes = [6, 3]
mode = "open_lop"
[beam.oven]
power_W = 0
)";

class Table : public ::testing::Test {
 protected:
  ConfigDocument document = ConfigDocument::parse(kDevice, "nominal.toml");
  ConfigTable beam = document.root().table("beam");
};

void refused(const std::function<void()>& reading, const std::string& message) {
  EXPECT_EQ(rejection(reading), "nominal.toml:" + message);
}

TEST_F(Table, TellsNumbersFromOtherValues) {
  for (const char* key : {"length_m", "count"})
    EXPECT_TRUE(beam.holds_number(key)) << key;
  for (const char* key : {"mode", "trimmed", "sizes", "oven", "absent"})
    EXPECT_FALSE(beam.holds_number(key)) << key;
}

TEST_F(Table, CollectsNumbersWithTheirRanges) {
  std::vector<NumberRead> numbers;
  document.collect_numbers(&numbers);
  beam.number("length_m", positive());
  beam.integer("count", 0, 20);
  beam.numbers("offset_m", 4, between(-1, 10));
  beam.flag("trimmed");
  document.collect_numbers(nullptr);
  beam.number("tip");
  ASSERT_EQ(numbers.size(), 6U);
  EXPECT_EQ(numbers[0].key, "beam.length_m");
  EXPECT_EQ(numbers[0].value, 0.04);
  EXPECT_TRUE(numbers[0].range.low_open);
  EXPECT_FALSE(numbers[0].whole);
  EXPECT_EQ(numbers[1].key, "beam.count");
  EXPECT_TRUE(numbers[1].whole);
  EXPECT_EQ(numbers[1].range.high, 20);
  EXPECT_EQ(numbers[5].key, "beam.offset_m[3]");
  EXPECT_EQ(numbers[5].range.low, -1);
}

TEST_F(Table, ReadsEveryKindOfValue) {
  EXPECT_EQ(document.root().text("name"), "unit 7");
  EXPECT_EQ(beam.number("length_m"), 0.04);
  EXPECT_EQ(beam.number("count"), 12.0);
  EXPECT_EQ(beam.integer("count", 0, 20), 12);
  EXPECT_TRUE(beam.flag("trimmed"));
  EXPECT_EQ(beam.numbers("offset_m"),
            (std::vector<double>{14e-6, -5e-6, 8.0, 0.0}));
  EXPECT_EQ(beam.numbers("offset_m", 4),
            (std::vector<double>{14e-6, -5e-6, 8.0, 0.0}));
  EXPECT_EQ(beam.integers("sizes", 1, 9), (std::vector<long>{6, 3}));
  EXPECT_EQ(beam.texts("inputs"),
            (std::vector<std::string>{"temperature", "output"}));
  EXPECT_EQ(beam.rows("points", 2),
            (std::vector<std::vector<double>>{{0.0, 25.0}, {10.5, -40.0}}));
  EXPECT_EQ(beam.table("oven").number("power_W"), 0.0);
  EXPECT_EQ(beam.choice("mode", {"closed", "open_lop"}), "open_lop");
}

TEST_F(Table, TakesTheDefaultOfAnAbsentKeyOnly) {
  EXPECT_EQ(beam.number_or("length_m", 7.0), 0.04);
  EXPECT_EQ(beam.number_or("width_m", 7.0), 7.0);
  EXPECT_EQ(beam.integer_or("count", 3, 0, 99), 12);
  EXPECT_EQ(beam.integer_or("counts", 3, 0, 99), 3);
  EXPECT_TRUE(beam.flag_or("trimmed", false));
  EXPECT_TRUE(beam.flag_or("cut", true));
  EXPECT_EQ(beam.text_or("mode", "x"), "open_lop");
  EXPECT_EQ(beam.text_or("modus", "x"), "x");
  EXPECT_EQ(beam.choice_or("modus", "closed", {"closed"}), "closed");
  EXPECT_EQ(beam.optional_number("length_m"), 0.04);
  EXPECT_EQ(beam.optional_number("width_m"), std::nullopt);
  EXPECT_EQ(beam.optional_text("modus"), std::nullopt);
  EXPECT_FALSE(beam.optional_table("heater").has_value());
  EXPECT_EQ(beam.table_or_empty("heater").number_or("power_W", 2.0), 2.0);
  EXPECT_EQ(beam.table_or_empty("oven").number_or("power_W", 2.0), 0.0);
}

TEST_F(Table, NamesFileLineColumnKeyValueAndRange) {
  refused([&] { beam.number("tip", positive()); },
          "6:7: beam.tip: -0.04 is out of range; expected a number > 0");
  refused([&] { beam.number_or("tip", 1.0, between(0, 1)); },
          "6:7: beam.tip: -0.04 is out of range; expected a number in [0, 1]");
  refused([&] { beam.optional_number("tip", non_negative()); },
          "6:7: beam.tip: -0.04 is out of range; expected a number >= 0");
  refused(
      [&] { beam.integer("count", 1, 10); },
      "5:9: beam.count: 12 is out of range; expected an integer in [1, 10]");
}

TEST_F(Table, RangeEndsAreAllowedUnlessOpen) {
  const double power = 0.0;  // as in the file
  const ConfigTable oven = beam.table("oven");
  EXPECT_EQ(oven.number("power_W", non_negative()), power);
  EXPECT_EQ(oven.number("power_W", between(0.0, 1.0)), power);
  EXPECT_EQ(oven.number("power_W", between(-1.0, 0.0)), power);
  refused([&] { oven.number("power_W", positive()); },
          "14:11: beam.oven.power_W: 0 is out of range; expected a number > 0");
  refused(
      [&] {
        oven.number("power_W", {0, 1, true, true});
      },
      "14:11: beam.oven.power_W: 0 is out of range; expected a number in (0, "
      "1)");
}

TEST_F(Table, SaysWhereAMissingKeyBelongs) {
  refused([&] { beam.number("width_m", positive()); },
          "3:1: beam.width_m: missing; expected a number > 0");
  refused([&] { beam.text("label"); },
          "3:1: beam.label: missing; expected a text in quotes");
  refused([&] { document.root().table("bond"); },
          "1:1: bond: missing; expected a table [bond]");
  refused([&] { beam.table_or_empty("heater").number("power_W"); },
          "3:1: beam.heater.power_W: missing; expected a finite number");
}

TEST_F(Table, RejectsAnotherType) {
  refused(
      [&] { beam.number("mode"); },
      "12:8: beam.mode: \"open_lop\" is wrong here; expected a finite number");
  refused([&] { beam.number("offset_m"); },
          "8:12: beam.offset_m: an array of 4 is wrong here; expected a finite "
          "number");
  refused(
      [&] { beam.integer("length_m", 0, 9); },
      "4:12: beam.length_m: 0.04 is wrong here; expected an integer in [0, 9]");
  refused([&] { beam.flag_or("count", true); },
          "5:9: beam.count: 12 is wrong here; expected true or false");
  refused([&] { beam.text("trimmed"); },
          "7:11: beam.trimmed: true is wrong here; expected a text in quotes");
  refused([&] { beam.table("count"); },
          "5:9: beam.count: 12 is wrong here; expected a table");
  refused(
      [&] { beam.numbers("oven"); },
      "13:1: beam.oven: a table is wrong here; expected an array of numbers");
}

TEST_F(Table, NamesTheElementOfAnArray) {
  refused(
      [&] { beam.numbers("offset_m", positive()); },
      "8:20: beam.offset_m[1]: -5e-06 is out of range; expected a number > 0");
  refused([&] { beam.numbers("inputs"); },
          "10:11: beam.inputs[0]: \"temperature\" is wrong here; expected a "
          "finite number");
  refused([&] { beam.texts("sizes"); },
          "11:10: beam.sizes[0]: 6 is wrong here; expected a text in quotes");
  refused(
      [&] { beam.integers("sizes", 4, 9); },
      "11:13: beam.sizes[1]: 3 is out of range; expected an integer in [4, 9]");
}

TEST_F(Table, RejectsAnotherCountOfNumbers) {
  refused([&] { beam.numbers("offset_m", 3); },
          "8:12: beam.offset_m: an array of 4 is wrong here; expected an array "
          "of 3 numbers");
  refused([&] { beam.rows("points", 3); },
          "9:11: beam.points[0]: an array of 2 is wrong here; expected an "
          "array of 3 numbers");
  refused(
      [&] { beam.rows("sizes", 2); },
      "11:10: beam.sizes[0]: 6 is wrong here; expected an array of 2 numbers");
}

TEST_F(Table, SuggestsTheNearestChoice) {
  refused(
      [&] {
        beam.choice("mode", {"open_loop", "force_rebalance"});
      },
      "12:8: beam.mode: \"open_lop\" is not known; did you mean \"open_loop\"? "
      "expected one of \"open_loop\", \"force_rebalance\"");
  refused(
      [&] {
        beam.choice_or("mode", "a", {"a", "b"});
      },
      "12:8: beam.mode: \"open_lop\" is not known; expected one of \"a\", "
      "\"b\"");
}

TEST_F(Table, GivesThePlaceForErrorsOfTheReader) {
  EXPECT_EQ(beam.place("count"), "nominal.toml:5:9: beam.count");
  EXPECT_EQ(beam.place("points", 1), "nominal.toml:9:20: beam.points[1]");
  refused([&] { beam.fail("count", "12 is not a power of 2"); },
          "5:9: beam.count: 12 is not a power of 2");
}

TEST(Numbers, NanAndInfinityAreRejectedWhereverTheyStand) {
  const ConfigDocument document = ConfigDocument::parse(
      "[a]\nx = nan\ny = -inf\nz = [1, +inf]\nw = [[0, nan]]\n", "scn.toml");
  const ConfigTable a = document.root().table("a");
  EXPECT_EQ(rejection([&] { a.number("x"); }),
            "scn.toml:2:5: a.x: nan is not finite; expected a finite number");
  EXPECT_EQ(rejection([&] { a.number_or("y", 0.0, between(-1, 1)); }),
            "scn.toml:3:5: a.y: -inf is not finite; expected a number in [-1, "
            "1]");
  EXPECT_EQ(
      rejection([&] { a.numbers("z"); }),
      "scn.toml:4:9: a.z[1]: inf is not finite; expected a finite number");
  EXPECT_EQ(
      rejection([&] { a.rows("w", 2); }),
      "scn.toml:5:10: a.w[0][1]: nan is not finite; expected a finite number");
}

}  // namespace
}  // namespace beamgyro::internal::table_test
