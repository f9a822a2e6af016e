// SPDX-License-Identifier: MIT
// Logs as instruments other than ours write them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::log_kinds_test {
namespace {

using Numbers = std::vector<double>;

const std::string kRest = "\n" + gyro_and_temperature();

std::string rejection_by(const std::string& map, const std::string& text,
                         const std::string& second = "") {
  return rejection([&] { imported(map, text, second); });
}

void expect_says(const std::string& message, const std::string& part) {
  EXPECT_TRUE(holds(message, part));
}

std::string time_map(const std::string& keys) {
  return "[time]\ncolumn = \"t\"\n" + keys + kRest;
}

const std::string kIso = "format = \"iso\"\n";

TEST(LogKinds, DatesBecomeSeconds) {
  const ImportedLog log = imported(
      time_map(kIso),
      "t,w,T\n2026-02-28T23:59:59.75Z,1,25\n2026-03-01T00:00:00.5Z,2,25\n,3,25"
      "\n2026-03-01T01:00:02+01:00,4,25\n");
  EXPECT_EQ(log.recording.time, (Numbers{0, 0.75, 2.25}));
  EXPECT_EQ(
      log.counts.dropped[static_cast<std::size_t>(DropReason::kMissing)].rows,
      1u);
}

TEST(LogKinds, ATimeOfTheDayGoesOnAfterMidnight) {
  const std::string map = time_map("format = \"%H:%M:%S\"\n");
  EXPECT_EQ(
      imported(map, "t,w,T\n23:59:59,1,25\n00:00:01.5,2,25\n").recording.time,
      (Numbers{0, 2.5}));
  expect_says(rejection_by(map, "t,w,T\n10:00:02,1,25\n10:00:01,2,25\n"),
              "goes back by 1 s");
}

TEST(LogKinds, DateAndTimeInTwoColumns) {
  const ImportedLog log =
      imported("delimiter = \" \"\n" +
                   time_map("date_column = \"d\"\nformat = \"iso\"\n"),
               "  d t    w T\n2026-03-05 14:00:00  1 25\n2026-03-05\t14:00:01 "
               "2   25 \n");
  EXPECT_EQ(log.recording.time, (Numbers{0, 1}));
  EXPECT_EQ(column_values(log.recording, "rate"), (Numbers{1, 2}));
}

TEST(LogKinds, ACellThatIsNoDateIsNamedWithItsForm) {
  EXPECT_EQ(rejection_by(time_map("format = \"%d.%m.%Y %H:%M\"\n"),
                         "t,w,T\n2026-03-05,1,25\n"),
            "log.csv:2:1: '2026-03-05' is no time of the form \"%d.%m.%Y "
            "%H:%M\" or does not exist; expected one such as 05.03.2026 14:07 "
            "(or another map.toml:3:10: time.format)");
}

TEST(LogKinds, DecimalCommas) {
  const std::string map = "decimal = \",\"\n" + time_map("unit = \"s\"\n");
  const ImportedLog log =
      imported(map, "t;w;T\n0,5;-1,25;25\n1;1,5e-1;+25,5\n");
  EXPECT_EQ(log.recording.time, (Numbers{0, 0.5}));
  EXPECT_EQ(column_values(log.recording, "rate"), (Numbers{-1.25, 0.15}));
  EXPECT_EQ(column_values(log.recording, "temperature"), (Numbers{25, 25.5}));
  expect_says(rejection_by(map, "t;w;T\n0;1.5;25\n"),
              "log.csv:2:3: '1.5' is not a number; expected one such as -12,5, "
              "or decimal = \".\" in the map");
  // Without a semicolon the blanks are the delimiter, never the comma.
  EXPECT_EQ(imported(map, "t w T\n0,5 1 25\n1 2 25\n").recording.time,
            (Numbers{0, 0.5}));
}

TEST(LogKinds, LinesThatEndInACarriageReturn) {
  const std::string map = time_map("unit = \"s\"\n");
  EXPECT_EQ(imported(map, "t,w,T\r0,1,25\r1,2,25\r").recording.time,
            (Numbers{0, 1}));
  expect_says(rejection_by(map, "t,w,T\r0,1,25\r1,x,25\r"), "log.csv:3:3: ");
}

TEST(LogKinds, MillivoltsOfGyroAndThermometer) {
  const ImportedLog log = imported(R"([time]
rate_Hz = 10
[gyro]
column = "w"
unit = "mV"
offset = 2500
scale_deg_per_s = 0.08
[temperature]
column = "T"
unit = "mV"
scale_K = 0.1
offset_degC = -50
)",
                                   "w,T\n2500,750\n2512.5,760\n");
  EXPECT_EQ(column_values(log.recording, "output"), (Numbers{2.5, 2.5125}));
  EXPECT_EQ(column_values(log.recording, "rate"), (Numbers{0, 1}));
  EXPECT_EQ(column_values(log.recording, "temperature"), (Numbers{25, 26}));
}

TEST(LogKinds, APartOfTheLog) {
  const std::string rows = "t,w,T\n10,1,25\n11,2,25\n12.5,3,25\n13,4,25\n";
  const ImportedLog log =
      imported(time_map("unit = \"s\"\nfrom = 11\nto = 13\n"), rows);
  EXPECT_EQ(log.recording.time, (Numbers{0, 1.5}));
  EXPECT_EQ(
      log.counts.dropped[static_cast<std::size_t>(DropReason::kOutside)].rows,
      2u);
  EXPECT_EQ(imported(time_map("unit = \"s\"\nfrom = 11.0\nzero = 10.5\n"), rows)
                .recording.time,
            (Numbers{0.5, 2, 2.5}));
  EXPECT_EQ(imported("[time]\nrate_Hz = 2\nfrom = 1\nto = 3" + kRest, rows)
                .recording.time,
            (Numbers{0, 0.5}));
  const std::string dates =
      "t,w,T\n2026-03-05T10:00,1,25\n2026-03-05T11:00,2,25\n"
      "2026-03-05T12:00,3,25\n";
  EXPECT_EQ(imported(time_map(kIso + "from = \"2026-03-05 10:30\"\n"), dates)
                .recording.time,
            (Numbers{0, 3600}));
  expect_says(rejection_by(time_map(kIso + "from = \"5.3.2026\"\n"), dates),
              "time.from: \"5.3.2026\" is no time of the form \"iso\"");
  expect_says(
      rejection_by(time_map("unit = \"s\"\nfrom = 13\nto = 11\n"), rows),
      "time.to: is not after from");
  expect_says(rejection_by(time_map("unit = \"s\"\nfrom = 20\n"), rows),
              "4 outside time.from and time.to, the first in line 2");
}

const std::string kJoin =
    joining_map("unit = \"ms\"\n", "unit = \"s\"\n", "2") +
    "[join.true_rate]\ncolumn = \"r\"\nunit = \"deg/s\"\n";

TEST(LogKinds, TheSlowLogIsInterpolated) {
  const ImportedLog log =
      imported(kJoin, "t,w\n900,1\n1000,2\n1500,3\n2000,4\n2500,5\n6000,6\n",
               "t,T,r\n1,20,0\n2,22,-4\n5,28,0\n6,29,1\n");
  EXPECT_EQ(log.recording.time, (Numbers{0, 0.5, 1, 5}));
  EXPECT_EQ(column_values(log.recording, "rate"), (Numbers{2, 3, 4, 6}));
  EXPECT_EQ(column_values(log.recording, "temperature"),
            (Numbers{20, 21, 22, 29}));
  EXPECT_EQ(column_values(log.recording, "true_rate"), (Numbers{0, -2, -4, 1}));
  EXPECT_EQ(
      log.counts.dropped[static_cast<std::size_t>(DropReason::kNotJoined)].rows,
      2u);
  ASSERT_TRUE(log.joined);
  EXPECT_EQ(log.joined->kept, 4u);
}

// Returns how many of 2001 rows are kept when 101 rows of a second log are
// joined to them.
std::size_t kept_with(const std::string& gyro_time, const std::string& time,
                      const std::string& gap,
                      const std::function<std::string(int)>& gyro_row,
                      const std::function<std::string(int)>& chamber_row) {
  std::string rows = "t,w\n", slow = "t,T\n";
  for (int k = 0; k <= 2000; ++k) rows += gyro_row(k) + ",0.2\n";
  for (int k = 0; k <= 100; ++k) slow += chamber_row(k) + ",20\n";
  return imported(joining_map(gyro_time, time, gap), rows, slow).counts.kept;
}

TEST(LogKinds, APeriodOfMaxGapIsJoinedWhateverItsRounding) {
  const auto plain = [](int step) {
    return [step](int k) { return fmt::format("{}", step * k); };
  };
  const std::string ms = "unit = \"ms\"\n";
  EXPECT_EQ(kept_with(ms, ms, "0.1", plain(5), plain(100)), 2001u);
  EXPECT_EQ(kept_with(ms, ms, "0.2", plain(5), plain(200)), 2001u);
  EXPECT_EQ(kept_with(ms, ms + "zero = 300\n", "0.1", plain(5),
                      [](int k) { return fmt::format("{}", 300 + 100 * k); }),
            2001u);
  const auto epoch = [](int step) {
    return [step](int k) {
      return fmt::format("{}.{:03}", 1772719200 + step * k / 1000,
                         step * k % 1000);
    };
  };
  const std::string s = "unit = \"s\"\n";
  EXPECT_EQ(kept_with(s, s, "0.1", epoch(5), epoch(100)), 2001u);
  const std::string zero = s + "zero = 1772719200\n";
  EXPECT_EQ(kept_with(zero, zero, "0.1", epoch(5), epoch(100)), 2001u);
  const auto date = [](int step) {
    return [step](int k) {
      return fmt::format("2026-03-05T14:00:{:02}.{:03}", step * k / 1000,
                         step * k % 1000);
    };
  };
  EXPECT_EQ(kept_with(kIso, kIso, "0.1", date(5), date(100)), 2001u);
  // Half a percent less than the period is less.
  EXPECT_EQ(kept_with(ms, ms, "0.0995", plain(5), plain(100)), 101u);
}

TEST(LogKinds, ARowThatIsLateByRoundingIsAtTheLastOneOfTheSecondLog) {
  const std::string seconds = "unit = \"s\"\n";
  const ImportedLog log =
      imported(joining_map(seconds, seconds, "2"),
               "t,w\n0.29999999999999993,1\n0.6000000000000001,2\n0.601,3\n",
               "t,T\n0.3,21\n0.6,22\n");
  EXPECT_EQ(column_values(log.recording, "temperature"), (Numbers{21, 22}));
}

TEST(LogKinds, JoinsThatCannotBe) {
  const std::string rows = "t,w\n900,1\n1000,2\n",
                    slow = "t,T,r\n0,20,0\n1,21,0\n";
  expect_says(rejection_by(kJoin, rows), "map.toml:7:1: join: needs a second");
  expect_says(rejection_by(kJoin.substr(0, kJoin.find("[join]")), rows, slow),
              "join = second.csv: the map has no table [join]");
  expect_says(rejection_by(kJoin, rows, "t,T,r\n50,20,0\n51,21,0\n"),
              "from 0.900000 to 1.000000 s");
  expect_says(rejection_by(kJoin, rows, "t,T,r\n0,20,0\n1,x,0\n"),
              "second.csv:3:3: 'x' is not a number");
  expect_says(rejection_by(kJoin, rows, "t,T,r\n0,20,0\n1,300,0\n"),
              "second.csv:3:3: '300' is 300 degC");
  expect_says(rejection_by(kJoin + "[temperature]\ncolumn = \"w\"\nunit = "
                                   "\"degC\"\n",
                           rows, slow),
              "join.temperature: is in the other log, too");
  expect_says(
      rejection_by(kJoin.substr(0, kJoin.find("[join.temp")), rows, slow),
      "join: takes nothing from the second log");
}

}  // namespace
}  // namespace beamgyro::internal::log_kinds_test
