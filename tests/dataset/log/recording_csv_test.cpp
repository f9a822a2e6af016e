// SPDX-License-Identifier: MIT
#include "dataset/log/recording_csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/config/rejection.h"

namespace beamgyro::internal::recording_csv_test {
namespace {

std::string message_for(const std::string& text) {
  return rejection([&] { parse_recording_csv(text, "run.csv"); });
}

TEST(RecordingCsv, KnownColumnsGetTheirUnitsAndRoles) {
  const Recording run = parse_recording_csv(
      "time,rate,temperature,status,true_rate,compensated_rate\n"
      "0,nan,nan,1,2,nan\n0.5,1.25,25,2,2,0.5\n",
      "run.csv");
  EXPECT_EQ(run.time, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(run.status,
            (std::vector<std::uint8_t>{kUnpowered, kOutputSaturated}));
  ASSERT_EQ(run.columns.size(), 4U);
  EXPECT_EQ(run.columns[0].units, "degree/s");
  EXPECT_TRUE(std::isnan(run.columns[0].values[0]));
  EXPECT_EQ(run.columns[0].values[1], 1.25);
  EXPECT_EQ(run.columns[1].units, "degC");
  EXPECT_EQ(run.columns[2].role, Role::kTruth);
  EXPECT_EQ(run.columns[3].role, Role::kCompensated);
}

TEST(RecordingCsv, UnitsInBracketsAreConverted) {
  const Recording run = parse_recording_csv(
      "time [ms],rate [deg/h],temperature [K],status,wind [m/s]\n"
      "500,3600,298.15,0,7\n",
      "run.csv");
  EXPECT_DOUBLE_EQ(run.time[0], 0.5);
  EXPECT_DOUBLE_EQ(run.columns[0].values[0], 1);
  EXPECT_EQ(run.columns[0].units, "degree/s");
  EXPECT_DOUBLE_EQ(run.columns[1].values[0], 25);
  EXPECT_EQ(run.columns[2].name, "wind");
  EXPECT_EQ(run.columns[2].units, "m/s");
}

TEST(RecordingCsv, SaysWhatIsWrong) {
  EXPECT_TRUE(holds(message_for("time,rate\n0,1\n"), "no column 'status'"));
  EXPECT_TRUE(holds(message_for("rate,status\n0,1\n"), "no column 'time'"));
  EXPECT_TRUE(holds(message_for("time,status\n0,8\n"), "run.csv:2: status 8"));
  EXPECT_TRUE(
      holds(message_for("time,rate [furlong],status\n0,1,0\n"), "furlong"));
  EXPECT_TRUE(
      holds(message_for("time,rate,status\n0,nan,0\n"), "while powered"));
  EXPECT_TRUE(
      holds(message_for("time,rate,status\n0,1,0\n0,1,0\n"), "not after"));
}

TEST(RecordingCsv, OnlyANameOfTimeAndStatusMakesARecording) {
  EXPECT_TRUE(is_recording_csv("time,rate,status\n"));
  EXPECT_TRUE(is_recording_csv("time [s],rate [deg/s],status\n0,1,0"));
  EXPECT_FALSE(is_recording_csv("time,rate\n0,1\n"));
  EXPECT_FALSE(is_recording_csv("1,2\n"));
  EXPECT_FALSE(is_recording_csv(""));
}

}  // namespace
}  // namespace beamgyro::internal::recording_csv_test
