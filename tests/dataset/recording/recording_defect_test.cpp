// SPDX-License-Identifier: MIT
#include "dataset/recording/recording_defect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"

namespace beamgyro::internal::recording_defect_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Defect : public ::testing::Test {
 protected:
  Recording recording = sample_recording(10);  // off at samples 0 and 1
};

TEST_F(Defect, AWholeRecordingHasNone) {
  EXPECT_EQ(recording_defect(recording), "");
  EXPECT_EQ(recording_defect(sample_recording(1)), "");
}

TEST_F(Defect, TimeMustBeThereFiniteAndIncreasing) {
  EXPECT_EQ(recording_defect(Recording{}),
            "time: no samples; expected at least one");
  recording.time[4] = recording.time[3];
  EXPECT_EQ(recording_defect(recording),
            "time: sample 4 is 0.3 s, not after 0.3 s before it");
  recording.time[4] = std::nan("");
  EXPECT_EQ(recording_defect(recording),
            "time: sample 4 is nan; expected a finite time");
}

TEST_F(Defect, EveryColumnHasOneValuePerTime) {
  recording.columns[2].values.pop_back();
  EXPECT_EQ(recording_defect(recording), "temperature: 9 values for 10 times");
  recording.status.pop_back();
  EXPECT_EQ(recording_defect(recording), "status: 9 values for 10 times");
}

TEST_F(Defect, NamesAreUniqueIdentifiers) {
  recording.columns[1].name = "output";
  EXPECT_EQ(recording_defect(recording), "output: the name is taken");
  recording.columns[1].name = "time";
  EXPECT_EQ(recording_defect(recording), "time: the name is taken");
  for (const char* name : {"", "a,b", "a/b", "2nd", "a b"}) {
    recording.columns[1].name = name;
    EXPECT_TRUE(holds(recording_defect(recording), "is no name for a variable"))
        << name;
  }
}

TEST_F(Defect, ATruthIsFiniteAlsoWhileUnpowered) {
  recording.columns[6].values[0] = std::nan("");
  EXPECT_EQ(recording_defect(recording),
            "true_rate: sample 0 is nan; a truth is always finite");
  recording.columns[6].values[0] = -kInfinity;
  EXPECT_EQ(recording_defect(recording),
            "true_rate: sample 0 is -inf; a truth is always finite");
}

TEST_F(Defect, AMeasuredNanNeedsTheUnpoweredBit) {
  recording.columns[0].values[2] = std::nan("");
  EXPECT_EQ(recording_defect(recording),
            "output: sample 2 is nan while powered; expected a finite value");
  recording.status[2] |= kUnpowered;
  EXPECT_EQ(recording_defect(recording), "");
  recording.columns[0].values[2] = kInfinity;
  EXPECT_EQ(recording_defect(recording),
            "output: sample 2 is inf while unpowered; expected nan");
}

TEST_F(Defect, TextsHoldNoNul) {
  recording.columns[3].units = std::string("H\0z", 3);
  EXPECT_EQ(recording_defect(recording),
            "drive_frequency: a NUL in units, long_name or comment");
  recording.columns[3].units = "Hz";
  recording.columns[3].comment = std::string("a\0b", 3);
  EXPECT_EQ(recording_defect(recording),
            "drive_frequency: a NUL in units, long_name or comment");
  recording.columns[3].comment = "ab";
  recording.scenario_text = std::string("a\0b", 3);
  EXPECT_EQ(recording_defect(recording), "a NUL in the texts of the recording");
}

}  // namespace
}  // namespace beamgyro::internal::recording_defect_test
