// SPDX-License-Identifier: MIT
#include "dataset/log/csv_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "dataset/netcdf/recording_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::csv_file_test {
namespace {

namespace fs = std::filesystem;

std::string rejection_of(const std::string& text) {
  return rejection([&] { parse_csv(text, "log.csv"); });
}

TEST(CsvFile, ReadsNamesAndColumns) {
  const CsvTable table =
      parse_csv("time_s,temperature_degC\n0,25\n60.5,-40e0\n", "log.csv");
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"time_s", "temperature_degC"}));
  EXPECT_EQ(table.column("time_s"), (std::vector<double>{0.0, 60.5}));
  EXPECT_EQ(table.column("temperature_degC"),
            (std::vector<double>{25.0, -40.0}));
  EXPECT_EQ(table.place(1), "log.csv:3");
}

TEST(CsvFile, ReadsASeriesWithoutNames) {
  const CsvTable table = parse_csv("1\n2.5\n-3\n", "series.csv");
  EXPECT_TRUE(table.names.empty());
  ASSERT_EQ(table.columns.size(), 1u);
  EXPECT_EQ(table.columns[0], (std::vector<double>{1.0, 2.5, -3.0}));
  EXPECT_EQ(table.place(1), "series.csv:2");
}

TEST(CsvFile, AcceptsByteOrderMarkCarriageReturnsBlanksAndQuotedNames) {
  const CsvTable table =
      parse_csv("\xEF\xBB\xBF\"a\", b\r\n +1 ,\t2\r\n3,4\r\n\r\n", "log.csv");
  EXPECT_EQ(table.names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(table.column("a"), (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(table.column("b"), (std::vector<double>{2.0, 4.0}));
}

TEST(CsvFile, NamesThePlaceOfWhatIsWrong) {
  const std::pair<std::string, std::string> texts[] = {
      {"a,b\n1,2\n3,x4\n",
       "3:3: 'x4' is not a number; expected one such as -12.5"},
      {"1,2\n3, 4;5\n",
       "2:4: '4;5' is not a number; expected one such as -12.5"},
      {"a,b\n1,\n", "2:3: '' is not a number; expected one such as -12.5"},
      {"1,b\n3,4\n", "1:3: 'b' is not a number; expected one such as -12.5"},
      {"a\n0x10\n", "2:1: '0x10' is not a number; expected one such as -12.5"},
      {"a,b\n1,2\n3\n", "3:1: 1 cells; expected 2 as in the first line"},
      {"a,b\n1,2,3\n", "2:5: 3 cells; expected 2 as in the first line"},
      {"a,b\n1,2\n\n3,4\n", "3:1: 1 cells; expected 2 as in the first line"},
      {"", "1:1: the file is empty; expected rows of numbers"},
      {"\r\n \n", "1:1: the file is empty; expected rows of numbers"},
      {"a,b\n", "1:1: only a line of names; expected rows of numbers below it"},
      {"a,a\n1,2", "1:3: two columns are called 'a'"},
      {"a,\n1,2", "1:3: a column without a name"}};
  for (const auto& [text, message] : texts)
    EXPECT_EQ(rejection_of(text), "log.csv:" + message);
  EXPECT_TRUE(rejection_of(std::string("\x89HDF\r\n\0\0\1", 9))
                  .starts_with("log.csv:2:1: "));
}

TEST(CsvFile, RejectsNumbersThatAreNotFinite) {
  for (const char* cell : {"nan", "-inf", "1e999", "NaN"}) {
    EXPECT_EQ(rejection_of("a,b\n1," + std::string(cell)),
              "log.csv:2:3: '" + std::string(cell) +
                  "' is nan, infinite or out of range; expected a finite "
                  "number");
  }
}

TEST(CsvFile, NumbersTooSmallForADoubleAreZero) {
  const CsvTable table = parse_csv("a,b\n1e-400,-1e-400\n+2,0e999", "log.csv");
  EXPECT_EQ(table.column("a"), (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(table.column("b"), (std::vector<double>{0.0, 0.0}));
  EXPECT_NE(rejection_of("a,b\n1,+-2"), "");
}

TEST(CsvFile, AMissingColumnIsNamedWithThoseThereAre) {
  const CsvTable table = parse_csv("a,b\n1,2", "log.csv");
  EXPECT_EQ(rejection([&] { table.column("c"); }),
            "log.csv:1:1: no column 'c'; the file has a, b");
  const CsvTable bare = parse_csv("1,2", "log.csv");
  EXPECT_EQ(rejection([&] { bare.column("c"); }),
            "log.csv:1:1: no column 'c'; the file has no line of names");
}

TEST(CsvFile, AMissingFileIsNamed) {
  const TestDirectory folder;
  const fs::path file = folder.directory / "nowhere.csv";
  EXPECT_EQ(rejection([&] { read_csv(file); }),
            file.string() + ": cannot read: No such file or directory");
  EXPECT_EQ(rejection([&] { read_csv(folder.directory); }),
            folder.directory.string() + ": cannot read: Is a directory");
}

TEST(CsvFile, ARecordingReadsBackToTheSameBits) {
  Recording recording = sample_recording(50);
  for (std::uint8_t& status : recording.status) status = 0;
  double value = 0.1;
  for (Column& column : recording.columns) {
    for (double& entry : column.values) {
      entry = value;
      value *= std::abs(value) < 1e11 ? -1.37 : 1e-23;
    }
  }
  recording.columns[0].values[0] = std::numeric_limits<double>::denorm_min();
  recording.columns[0].values[1] = 1e12;  // the largest that files may hold
  recording.columns[0].values[2] = -0.0;
  const TestDirectory folder;
  const fs::path file = folder.directory / "bits.csv";
  write_recording(recording, file);
  const CsvTable table = read_csv(file);
  EXPECT_EQ(table.column("time"), recording.time);
  for (const Column& column : recording.columns) {
    const std::vector<double>& values = table.column(column.name);
    ASSERT_EQ(values.size(), column.values.size());
    for (std::size_t k = 0; k < values.size(); ++k)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(values[k]),
                std::bit_cast<std::uint64_t>(column.values[k]));
  }
}

}  // namespace
}  // namespace beamgyro::internal::csv_file_test
