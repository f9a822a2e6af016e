// SPDX-License-Identifier: MIT
#include "dataset/recording/recording.h"

#include <gtest/gtest.h>

#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"

namespace beamgyro::internal::recording_test {
namespace {

TEST(Recording, FindsAColumnByItsName) {
  const Recording recording = sample_recording(10);
  ASSERT_NE(find_column(recording, "temperature"), nullptr);
  EXPECT_EQ(find_column(recording, "temperature")->units, "degC");
  EXPECT_EQ(find_column(recording, "temperatur"), nullptr);
  EXPECT_EQ(&column_values(recording, "rate"), &recording.columns[1].values);
}

TEST(Recording, AMissingColumnIsNamedWithThoseThereAre) {
  Recording recording = sample_recording(10);
  recording.columns.resize(3);
  EXPECT_EQ(rejection([&] { column_values(recording, "true_rate"); }),
            "the recording has no variable 'true_rate'; it has output, rate, "
            "temperature");
  EXPECT_EQ(rejection([&] { column_values(Recording{}, "rate"); }),
            "the recording has no variable 'rate'; it has none");
}

TEST(Recording, StatusStandsAfterTheMeasuredColumns) {
  Recording recording = sample_recording(10);
  EXPECT_EQ(status_position(recording), 6u);
  recording.columns.resize(2);
  EXPECT_EQ(status_position(recording), 2u);
}

TEST(Recording, RolesAreSpelledAsInFiles) {
  EXPECT_EQ(role_name(Role::kMeasured), "measured");
  EXPECT_EQ(role_name(Role::kTruth), "truth");
  EXPECT_EQ(role_name(Role::kCompensated), "compensated");
}

}  // namespace
}  // namespace beamgyro::internal::recording_test
