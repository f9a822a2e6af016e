// SPDX-License-Identifier: MIT
#include "dataset/log/log_import.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::log_import_test {
namespace {

using Values = std::vector<double>;

const std::string kMap =
    "[time]\ncolumn = \"t\"\nunit = \"ms\"\n" + gyro_and_temperature();

ImportedLog log_of(const std::string& text, const std::string& map = kMap) {
  ImportedLog log = imported(map, text);
  EXPECT_EQ(log.counts.kept, log.recording.time.size());
  return log;
}

std::string rejection_of(const std::string& text,
                         const std::string& map = kMap) {
  return rejection([&] { log_of(text, map); });
}

DroppedRows dropped(const ImportedLog& log, DropReason reason) {
  return log.counts.dropped[static_cast<std::size_t>(reason)];
}

void expect_dropped(const ImportedLog& log, DropReason reason, std::size_t rows,
                    std::size_t first_line) {
  EXPECT_EQ(dropped(log, reason).rows, rows) << reason_name(reason);
  EXPECT_EQ(dropped(log, reason).first_line, first_line);
}

const Values& column(const ImportedLog& log, const char* name) {
  return column_values(log.recording, name);
}

std::string replaced(std::string text, const std::string& from,
                     const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(LogImport, MakesARecording) {
  const ImportedLog log =
      log_of("T,x,w,t\n25,a,1.5,1000\n25.5,b,-2,1020\n26,c,+3e-1,1041\n",
             kMap + "[true_rate]\nconstant_deg_per_s = 2\n");
  EXPECT_EQ(log.recording.time, (Values{0, 0.02, 0.041}));
  EXPECT_EQ(column(log, "rate"), (Values{1.5, -2, 0.3}));
  EXPECT_EQ(column(log, "temperature"), (Values{25, 25.5, 26}));
  EXPECT_EQ(column(log, "true_rate"), (Values{2, 2, 2}));
  EXPECT_EQ(log.recording.status, (std::vector<std::uint8_t>{0, 0, 0}));
  EXPECT_EQ(log.recording.fidelity, "imported");
  EXPECT_EQ(log.recording.seed, 0u);
  EXPECT_EQ(log.recording.scenario_text,
            kMap + "[true_rate]\nconstant_deg_per_s = 2\n");
  EXPECT_EQ(log.recording.device_text, "");
  EXPECT_EQ(log.counts.rows, 3u);
}

TEST(LogImport, ColumnsByNumberWithoutNames) {
  const ImportedLog log = log_of("0,1,25\n10,2,25\n", R"(header = false
[time]
column = 1
unit = "ms"
[gyro]
column = 2
unit = "V"
scale_deg_per_s = 10
[temperature]
column = 3
unit = "degC"
)");
  EXPECT_EQ(column(log, "output"), (Values{1, 2}));
  EXPECT_EQ(column(log, "rate"), (Values{10, 20}));
  EXPECT_EQ(find_column(log.recording, "true_rate"), nullptr);
}

TEST(LogImport, TimeForms) {
  const std::string rows = "t,w,T\n7,0,25\n8,0,25\n10,0,25\n";
  const auto times = [&](const std::string& from, const std::string& to) {
    return log_of(rows, replaced(kMap, from, to)).recording.time;
  };
  EXPECT_EQ(times("\"ms\"", "\"s\""), (Values{0, 1, 3}));
  EXPECT_EQ(times("\"ms\"", "\"us\""), (Values{0, 1e-6, 3e-6}));
  EXPECT_EQ(times("\"ms\"", "\"ns\""), (Values{0, 1e-9, 3e-9}));
  EXPECT_EQ(times("\"ms\"", "\"index\"\nrate_Hz = 50"), (Values{0, .02, .06}));
  EXPECT_EQ(times("\"ms\"", "\"s\"\noffset_s = 0.5"), (Values{7.5, 8.5, 10.5}));
  EXPECT_EQ(times("column = \"t\"\nunit = \"ms\"", "rate_Hz = 10"),
            (Values{0, 0.1, 0.2}));
}

TEST(LogImport, NanosecondsSince1970KeepEveryDigit) {
  const ImportedLog log =
      log_of("t,w,T\n1583600000123456789,0,25\n1583600000123456790,0,25\n",
             replaced(kMap, "\"ms\"", "\"ns\""));
  EXPECT_EQ(log.recording.time, (Values{0, 1e-9}));
}

TEST(LogImport, ACounterThatStartsOverGoesOn) {
  const std::string rows =
      "t,w,T\n4294967290,1,25\n4294967295,2,25\n4,3,25\n9,4,25\n";
  const std::string map = replaced(kMap, "\"ms\"", "\"us\"\nwrap_bits = 32");
  EXPECT_EQ(log_of(rows, map).recording.time, (Values{0, 5e-6, 10e-6, 15e-6}));
  EXPECT_TRUE(
      holds(rejection_of("t,w,T\n9,1,25\n8,1,25\n", map), "goes back by"));
  // A row that comes late, from before the end of the counter.
  EXPECT_TRUE(holds(rejection_of("t,w,T\n9,1,25\n4294967295,1,25\n", map),
                    "goes back by 1e-05 s"));
  EXPECT_EQ(rejection_of("t,w,T\n4294967296,1,25\n", map),
            "log.csv:2:1: '4294967296' is no count of 32 bits (wrap_bits in "
            "the map); expected a whole number from 0 to 4294967295");
  EXPECT_TRUE(holds(rejection_of("t,w,T\n0.5,1,25\n", map),
                    "'0.5' is no whole number"));
}

TEST(LogImport, ARowNumberCountsDroppedRows) {
  const ImportedLog log = log_of("t,w,T\n0,,25\n0,1,25\n0,nan,25\n0,2,25\n",
                                 replaced(kMap, "column = \"t\"\nunit = \"ms\"",
                                          "rate_Hz = 10\noffset_s = 0"));
  EXPECT_EQ(log.recording.time, (Values{0.1, 0.3}));
}

TEST(LogImport, RowsWithoutAValueAreDropped) {
  const std::string rows =
      "t,w,T,x\n0,1,25,\n10,,25,\n20,1,NaN,\n30,na,25,\nnan,1,25,\n40,-999,25,"
      "\n50,1,25,\n";
  const std::string map = "missing_markers = [\"-999\"]\n" + kMap;
  const ImportedLog log = log_of(rows, map);
  EXPECT_EQ(log.recording.time, (Values{0, 0.05}));
  expect_dropped(log, DropReason::kMissing, 5, 3);
  EXPECT_EQ(rejection_of(rows, map + "[rules]\nmissing = \"error\"\n"),
            "log.csv:3:4: '' is missing; expected a number (rules.missing = "
            "\"drop\" in the map drops such rows)");
}

TEST(LogImport, DuplicateTimesDropTheLaterRow) {
  const std::string rows = "t,w,T\n0,1,25\n0,2,25\n0,3,25\n10,4,25\n10,5,25\n";
  const ImportedLog log = log_of(rows);
  EXPECT_EQ(column(log, "rate"), (Values{1, 4}));
  expect_dropped(log, DropReason::kDuplicate, 3, 3);
  EXPECT_TRUE(
      holds(rejection_of(rows, kMap + "[rules]\nduplicates = \"error\"\n"),
            "log.csv:3:1: the time is that of line 2 again"));
}

TEST(LogImport, BackwardTimesAreAnErrorUnlessDropped) {
  const std::string rows = "t,w,T\n100,1,25\n90,2,25\n100,3,25\n110,4,25\n";
  EXPECT_TRUE(
      holds(rejection_of(rows),
            "log.csv:3:1: the time goes back by 0.01 s from that of line 2"));
  const ImportedLog log = log_of(rows, kMap + "[rules]\nbackward = \"drop\"\n");
  EXPECT_EQ(column(log, "rate"), (Values{1, 4}));
  expect_dropped(log, DropReason::kBackward, 1, 3);
  expect_dropped(log, DropReason::kDuplicate, 1, 4);
}

TEST(LogImport, RaggedRowsAreAnErrorUnlessDropped) {
  const std::string rows = "t,w,T\n0,1,25\n10,2\n20,3,25,7\n30,4,25\n";
  EXPECT_EQ(rejection_of(rows),
            "log.csv:3:5: 2 cells; expected 3 as in the first line (or "
            "rules.ragged = \"fill\", which reads the cells that lack as "
            "empty, or \"drop\", in the map)");
  const ImportedLog log = log_of(rows, kMap + "[rules]\nragged = \"drop\"\n");
  EXPECT_EQ(column(log, "rate"), (Values{1, 4}));
  expect_dropped(log, DropReason::kRagged, 2, 3);
}

TEST(LogImport, TheFilterPicksTheRowsOfOneSensor) {
  const std::string rows =
      "t,w,T,I\n0,1,25,0\n0,8,30,1\n10,2,25,0.0\n5,9,31,1\n";
  const ImportedLog log =
      log_of(rows, kMap + "[filter]\ncolumn = \"I\"\nvalue = 0\n");
  EXPECT_EQ(column(log, "rate"), (Values{1, 2}));
  expect_dropped(log, DropReason::kFiltered, 2, 3);
  const ImportedLog text =
      log_of(rows, kMap + "[filter]\ncolumn = \"I\"\nvalue = \"1\"\n");
  EXPECT_EQ(column(text, "rate"), (Values{8, 9}));
}

TEST(LogImport, OutliersAreDroppedByTheRule) {
  std::string rows = "t,w,T\n";
  for (int k = 0; k < 50; ++k) {
    rows += std::to_string(10 * k) + "," +
            (k == 20 ? "30000" : std::to_string(k % 7)) + "," +
            (k == 30 ? "-270" : std::to_string(25 + k % 2)) + "\n";
  }
  const ImportedLog log = log_of(rows, kMap + "[rules.outliers]\n");
  EXPECT_EQ(log.counts.kept, 48u);
  expect_dropped(log, DropReason::kRateOutlier, 1, 22);
  expect_dropped(log, DropReason::kTemperatureOutlier, 1, 32);
  EXPECT_TRUE(
      holds(rejection_of(rows), "log.csv:22:5: '30000' is 30000 degree/s"));
}

TEST(LogImport, StatusAndPowerBecomeBits) {
  const std::string rows =
      "t,w,T,s\n0,,,1\n10,1,25,0\n20,2,25,2\n30,3,25,5\n40,x,25,0\n";
  const ImportedLog log =
      log_of(rows, "powered_s = [[0, 0.035]]\n" + kMap +
                       "[status]\ncolumn = \"s\"\nvalid = "
                       "[0]\nunpowered = [1]\nsaturated = "
                       "[2]\n[true_rate]\nat_rest = true\n");
  EXPECT_EQ(log.recording.status,
            (std::vector<std::uint8_t>{kUnpowered, 0, kOutputSaturated,
                                       kLoopNotLocked, kUnpowered}));
  EXPECT_TRUE(std::isnan(column(log, "rate")[0]));
  EXPECT_TRUE(std::isnan(column(log, "temperature")[4]));
  EXPECT_EQ(column(log, "rate")[3], 3.0);
  EXPECT_EQ(column(log, "true_rate")[0], 0.0);
}

TEST(LogImport, WrongUnitsShowAsValuesNoGyroHas) {
  const std::string rows = "t,w,T\n0,1,25\n10,400,77\n";
  EXPECT_EQ(rejection_of(rows, replaced(kMap, "\"deg/s\"", "\"rad/s\"")),
            "log.csv:3:4: '400' is 22918.3 degree/s when read as map.toml:6:8: "
            "gyro.unit: \"rad/s\"; expected a number in [-20000, 20000], or "
            "another unit");
  EXPECT_EQ(rejection_of(rows, replaced(kMap, "\"degC\"", "\"K\"")),
            "log.csv:2:5: '25' is -248.15 degC when read as map.toml:9:8: "
            "temperature.unit: \"K\"; expected a number in [-100, 200], or "
            "another unit");
  EXPECT_EQ(rejection_of("t,w,T\n0,1,65236\n10,1,25\n",
                         replaced(kMap, "\"degC\"",
                                  "\"counts\"\nscale_K = 0.01\n"
                                  "offset_degC = 25")),
            "log.csv:2:5: '65236' is 677.36 degC when read as map.toml:9:8: "
            "temperature.unit: \"counts\"; expected a number in [-100, 200], "
            "or another scale or wrap_bits");
  EXPECT_EQ(
      rejection_of("t,w,T\n0,1,70000\n10,1,25\n",
                   replaced(kMap, "\"degC\"",
                            "\"counts\"\nwrap_bits = 16\nscale_K = 0.01\n"
                            "offset_degC = 25")),
      "log.csv:2:5: '70000' is no count of 16 bits (wrap_bits in the map); "
      "expected a whole number from 0 to 65535");
}

TEST(LogImport, ACellThatIsNoNumberIsNamed) {
  const auto says = [](const char* cell, const char* what) {
    const std::string message =
        rejection_of(std::string("t,w,T\n0,1,25\n10, ") + cell + ",25\n");
    EXPECT_TRUE(message.starts_with("log.csv:3:5: ")) << message;
    EXPECT_TRUE(holds(message, what));
  };
  says("1.2V", "'1.2V' is not a number");
  says("--", "'--' is not a number");
  says("+-1", "'+-1' is not a number");
  says("inf", "'inf' is infinite");
  says("1e999", "'1e999' is out of range");
}

TEST(LogImport, AColumnThatIsNotThereIsAnsweredWithTheNearest) {
  const std::string rows = "t,ww,T,T2,T2\n0,1,25,1,1\n10,1,25,1,1\n";
  EXPECT_EQ(rejection_of(replaced(rows, "ww", "gyro")),
            "map.toml:5:10: gyro.column: log.csv has no column \"w\"; it has "
            "t, gyro, T, T2, T2");
  EXPECT_EQ(rejection_of(rows, replaced(kMap, "\"w\"", "\"wW\"")),
            "map.toml:5:10: gyro.column: log.csv has no column \"wW\"; did you "
            "mean \"ww\"? it has t, ww, T, T2, T2");
  EXPECT_EQ(rejection_of(rows, replaced(kMap, "\"w\"", "\"T2\"")),
            "map.toml:5:10: gyro.column: log.csv has two columns \"T2\"; "
            "expected the number of one");
  EXPECT_EQ(rejection_of(rows, replaced(kMap, "\"w\"", "6")),
            "map.toml:5:10: gyro.column: 6 is out of range; log.csv has 5 "
            "columns");
  EXPECT_TRUE(holds(rejection_of("0,1,25\n", "header = false\n" + kMap),
                    "time.column: \"t\" is a name, and header = false"));
}

TEST(LogImport, AMessageIsOneLineWhateverTheLogHolds) {
  const std::string message = rejection_of("a\rb,\x1b[31m,w\n0,1,2\n");
  EXPECT_TRUE(holds(message, "it has a\\x0db, \\x1b[31m, w"));
}

TEST(LogImport, TooFewRowsAreNoRecording) {
  EXPECT_EQ(rejection_of("t,w,T\n"),
            "log.csv: 0 of 0 rows are usable; expected at least two");
  EXPECT_EQ(rejection_of("t,w,T\n0,1,25\n10,,25\n20,1,\n0,1,25\n",
                         kMap + "[rules]\nbackward = \"drop\"\n"),
            "log.csv: 1 of 4 rows are usable; expected at least two; 2 missing "
            "values, the first in line 3; 1 duplicate times, the first in line "
            "5");
}

}  // namespace
}  // namespace beamgyro::internal::log_import_test
