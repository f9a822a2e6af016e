// SPDX-License-Identifier: MIT
// What the import advises when a log is not as its map says.
#include <gtest/gtest.h>

#include "tests/config/rejection.h"
#include "tests/dataset/log/imported_log.h"

namespace beamgyro::internal::log_advice_test {
namespace {

using Readings = std::vector<double>;

const std::string kSeconds =
    "[time]\ncolumn = \"t\"\nunit = \"s\"\n" + gyro_and_temperature();

std::string refusal(const std::string& map, const std::string& log,
                    const std::string& second = "") {
  return rejection([&] { imported(map, log, second); });
}

void expect_advice(const std::string& message,
                   const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_TRUE(holds(message, part)) << part << " in: " << message;
}

void expect_no_advice(const std::string& message, const std::string& part) {
  EXPECT_FALSE(holds(message, part));
}

TEST(LogAdvice, AColumnOfDatesHasAFormat) {
  expect_advice(
      refusal("[time]\ncolumn = \"t\"\n" + gyro_and_temperature(),
              "t,w,T\n2026-03-05,1,25\n"),
      {"map.toml:1:1: time.unit: missing", "\"ms\"", "time.format = \"iso\""});
  expect_advice(refusal("[time]\ncolumn = \"t\"\nunits = \"s\"\n" +
                            gyro_and_temperature(),
                        "t,w,T\n0,1,25\n"),
                {"time.unit: missing", "there is a 'units' in line 3"});
}

TEST(LogAdvice, ALineOfUnitsIsSkipped) {
  const std::string log = "t,w,T\ns,deg/s,C\n0,1,25\n1,2,25\n";
  const std::string message = refusal(kSeconds, log);
  expect_advice(message, {"log.csv:2:1: 's' is not a number", "skip_rows = 1"});
  expect_no_advice(message, "missing_markers");
  EXPECT_EQ(imported("skip_rows = 1\n" + kSeconds, log).counts.kept, 2u);
  expect_advice(refusal("skip_rows = 2\n" + kSeconds,
                        "t,w,T\nTime,Rate,Temp\n\n[s],[m/s2],[C]\n-,-,-\n"
                        "0,1,25\n"),
                {"log.csv:5:1:", "skip_rows = 3"});
  // A first row with numbers is none.
  expect_no_advice(refusal(kSeconds, "t,w,T\n0,--,25\n"), "skip_rows");
}

TEST(LogAdvice, NamesThatComeAgainAreComments) {
  const std::string log = "t,w,T\n0,1,25\n1,2,25\nt,w,T\n2,3,25\n";
  const std::string message = refusal(kSeconds, log);
  expect_advice(message, {"log.csv:4:1: 't' ", "names again", "header = false",
                          "comment_prefixes = ['t,w,T']"});
  expect_no_advice(message, "missing_markers");
  EXPECT_EQ(imported(R"(header = false
comment_prefixes = ['t,w,T']
[time]
column = 1
unit = "s"
[gyro]
column = 2
unit = "deg/s"
)",
                     log)
                .counts.kept,
            3u);
}

TEST(LogAdvice, AHeaderWithinTheLogIsLeftOutByItsFirstLine) {
  const std::string log =
      "LabVIEW\nt\tw\tT\tComment\n0\t1\t25\nChannels\t2\t\t\n***End***\t\t\t\n"
      "t\tw\tT\tComment\n1\t2\t25\n";
  expect_advice(refusal(kSeconds, log),
                {"log.csv has no column \"t\"",
                 "line 2 holds it: header_line = 2 in the map"});
  const std::string second = "header_line = 2\n" + kSeconds;
  expect_advice(refusal(second, log), {"log.csv:3:7: 3 cells; expected 4",
                                       "rules.ragged = \"fill\""});
  const std::string fill = "rules.ragged = \"fill\"\n" + second;
  expect_advice(refusal(fill, log),
                {"log.csv:4:1: 'Channels' is not a number",
                 "repeated_header = \"Channels", "comment_prefixes"});
  const ImportedLog whole =
      imported("repeated_header = \"Channels\"\n" + fill, log);
  EXPECT_EQ(column_values(whole.recording, "rate"), (Readings{1, 2}));
  expect_advice(refusal("repeated_header = \"\"\n" + fill, log),
                {"map.toml:1:19: repeated_header: \"\" begins every line"});
  // A row with too many cells is ragged all the same.
  expect_advice(
      refusal("rules.ragged = \"fill\"\n" + kSeconds, "t,w,T\n0,1,25,3\n"),
      {"log.csv:2:9: 4 cells; expected 3"});
}

TEST(LogAdvice, AnAxisIsXYOrZ) {
  const std::string time = "[time]\ncolumn = \"t\"\nunit = \"s\"\n";
  expect_advice(refusal(time + "[gyro.w]\ncolumn = \"w\"\n", "t,w,T\n0,1,25\n"),
                {"gyro.column: missing, and 'w' is no axis", "[gyro.x]"});
  expect_advice(refusal(time + "[gyro]\nunit = \"deg/s\"\n", "t,w,T\n0,1,25\n"),
                {"gyro.column: missing; expected the name of the column"});
}

TEST(LogAdvice, AnExponentOfFortranIsNoDate) {
  const std::string message = refusal(kSeconds, "t,w,T\n0,1.5D-03,25\n");
  expect_advice(message, {"log.csv:2:3: '1.5D-03' is not a number",
                          "expected one such as 1.5e-03"});
  expect_no_advice(message, "time.format");
  expect_no_advice(refusal(kSeconds, "t,w,T\n0,1.5-3.2/,25\n"), "1.5e");
}

TEST(LogAdvice, DecimalCommasInQuotesBetweenCommas) {
  const std::string map = "decimal = \",\"\ndelimiter = \",\"\n" + kSeconds;
  const ImportedLog log = imported(
      map, "\"t\",w,\"T\"\n\"0\",\"0,1\",\"25,0\"\n1,\"-0,2\",\"25,5\"\n");
  EXPECT_EQ(column_values(log.recording, "rate"), (Readings{0.1, -0.2}));
  EXPECT_EQ(column_values(log.recording, "temperature"), (Readings{25, 25.5}));
  expect_advice(refusal(map, "t,w,T\n0,0,1,25,0\n"),
                {"log.csv:2:11: 5 cells; expected 3",
                 "a number with a decimal comma in quotes"});
}

TEST(LogAdvice, ALineOfNamesThatIsNotCutSaysItsDelimiter) {
  const std::string comma = "decimal = \",\"\n" + kSeconds;
  expect_advice(refusal(comma, "\"t\",\"w\",\"T\"\n\"0\",\"0,1\",\"25,0\"\n"),
                {"in place of \" \"", "delimiter = \",\" in the map"});
  expect_advice(refusal("delimiter = \";\"\n" + comma, "t,w,T\n0;0,1;25,0\n"),
                {"in place of \";\"", "delimiter = \",\"",
                 "header = false, skip_rows = 1"});
  expect_advice(refusal(kSeconds, "t,w,T\n0;1;25\n1;2;25\n"),
                {"log.csv:2:7: 1 cells; expected 3", "in place of \",\"",
                 "delimiter = \";\" in the map"});
  expect_advice(refusal(kSeconds, "t,w,T\n0;0,1;25,0\n"),
                {"log.csv:2:1: '0;0' is not a number", "in place of \",\"",
                 "delimiter = \";\" in the map"});
  expect_no_advice(refusal(kSeconds, "t,ww,T\n0,1,25\n"), "delimiter");
}

TEST(LogAdvice, ALogThatIsNotUtf8) {
  const std::string map =
      "[time]\ncolumn = \"t\"\nunit = \"s\"\n[gyro]\ncolumn "
      "= \"w [°/s]\"\nunit = \"deg/s\"\n";
  const std::string log = "t;w [\xB0/s]\n0;1\n1;2\n";
  expect_advice(refusal(map, log),
                {"map.toml:5:10: gyro.column: log.csv has no column",
                 "is not UTF-8", "number"});
  expect_no_advice(refusal(map, log), "did you mean");
  expect_no_advice(refusal(map, "t;w [°/h]\n0;1\n"), "UTF-8");
  EXPECT_EQ(
      imported("[time]\ncolumn = \"t\"\nunit = \"s\"\n[gyro]\ncolumn = 2\n"
               "unit = \"deg/s\"\n",
               log)
          .counts.kept,
      2u);
}

TEST(LogAdvice, ADateAndATimeBetweenBlanksAreTwoColumns) {
  const std::string map =
      "[time]\ncolumn = \"when\"\nformat = \"iso\"\n" + gyro_and_temperature();
  const std::string log =
      "when w T\n2026-03-05 14:00:00 1 25\n2026-03-05 14:00:01 1 25\n";
  const std::string message = refusal(map, log);
  expect_advice(message, {"log.csv:2:25: 4 cells; expected 3", "date_column",
                          "header = false, skip_rows = 1"});
  expect_no_advice(message, "ragged");
  const ImportedLog read = imported(R"(header = false
skip_rows = 1
[time]
date_column = 1
column = 2
format = "iso"
[gyro]
column = 3
unit = "deg/s"
[temperature]
column = 4
unit = "degC"
)",
                                    log);
  EXPECT_EQ(read.recording.time, (Readings{0, 1}));
}

TEST(LogTime, MinutesAndHoursBecomeSeconds) {
  const auto times = [](const std::string& unit) {
    return imported("[time]\ncolumn = \"t\"\nunit = \"" + unit + "\"\n" +
                        gyro_and_temperature(),
                    "t,w,T\n7,0,25\n7.1,0,25\n14,0,25\n")
        .recording.time;
  };
  EXPECT_EQ(times("min")[2], 420.0);
  EXPECT_NEAR(times("min")[1], 6.0, 1e-12);  // 14.2 - 14, of 2e-16 each
  EXPECT_EQ(times("h")[2], 25200.0);
}

TEST(LogAdvice, AGapLongerThanMaxGapIsNoMissingOverlap) {
  const std::string seconds = "unit = \"s\"\n";
  const auto joined = [&](const std::string& second) {
    return refusal(joining_map(seconds, seconds, "0.5"),
                   "t,w\n0.1,1\n0.2,1\n1.7,1\n", second);
  };
  const std::string message = joined("t,T\n0,20\n1,20\n2,20\n");
  expect_advice(message, {"map.toml:7:1: join", "0.5 s", "period of 1 s",
                          "a larger join.max_gap_s"});
  expect_no_advice(message, "overlap");
  expect_advice(joined("t,T\n10,20\n11,20\n"), {"expected logs that overlap"});
}

TEST(LogAdvice, ABadValueInTheSecondLogIsNoDriftOfTheFirst) {
  std::string gyro = "t,w\n";
  for (int k = 0; k < 2000; ++k) gyro += std::to_string(5 * k) + ",1\n";
  const std::string second =
      "t,T\n0,20\n1,20\n2,120\n3,20\n4,20\n5,20\n6,20\n7,20\n";
  const std::string map = joining_map("unit = \"ms\"\n", "unit = \"s\"\n", "2");
  EXPECT_EQ(imported(map, gyro, second).counts.kept, 1401u);
}

TEST(LogAdvice, AColumnThatIsMostlyBlankIsNamed) {
  std::string log = "t,w,T\n";
  for (int k = 0; k < 1000; ++k)
    log += std::to_string(k) + ",0.1," + (k % 100 == 0 ? "25" : "") + "\n";
  const LogCounts counts = imported(kSeconds, log).counts;
  EXPECT_EQ(counts.kept, 10u);
  EXPECT_EQ(counts.most_blank.rows, 990u);
  EXPECT_EQ(counts.most_blank.signal, "temperature");
}

}  // namespace
}  // namespace beamgyro::internal::log_advice_test
