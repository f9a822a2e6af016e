// SPDX-License-Identifier: MIT
#include "dataset/netcdf/recording_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/child_process.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::recording_file_test {
namespace {

namespace fs = std::filesystem;

// Samples begin .. end of a recording.
Recording cut(const Recording& whole, std::size_t begin, std::size_t end) {
  const auto part = [&](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(end),
                 values.end());
    values.erase(values.begin(),
                 values.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  Recording block = whole;
  part(block.time);
  part(block.status);
  for (Column& column : block.columns) part(column.values);
  return block;
}

class RecordingFileOf : public testing::TestWithParam<std::string>,
                        public TestDirectory {
 protected:
  fs::path named(const std::string& stem) const {
    return directory / (stem + GetParam());
  }

  Recording whole = sample_recording(1000);
};

TEST_P(RecordingFileOf, BlocksOfAnySizeMakeTheBytesOfTheWhole) {
  write_recording(whole, named("whole"));
  const std::string bytes = read_text_file(named("whole"));
  for (const std::size_t size : {1u, 7u, 256u, 999u}) {
    RecordingFile file(whole, 1000, named("blocks"));
    for (std::size_t k = 0; k < 1000; k += size)
      file.append(cut(whole, k, std::min<std::size_t>(k + size, 1000)));
    file.finish();
    EXPECT_EQ(read_text_file(named("blocks")), bytes) << size;
  }
}

TEST_P(RecordingFileOf, NothingAppearsBeforeItsEndAndNothingWithoutIt) {
  {
    RecordingFile file(whole, 1000, named("run"));
    file.append(cut(whole, 0, 500));
    EXPECT_FALSE(fs::exists(named("run")));
    EXPECT_TRUE(holds(rejection<std::runtime_error>([&] { file.finish(); }),
                      "500 samples; expected 1000"));
  }
  EXPECT_EQ(names().size(), 0u);
}

TEST_P(RecordingFileOf, DefectsAreNamedWithTheirPlaceInTheWhole) {
  RecordingFile file(whole, 1000, named("run"));
  file.append(cut(whole, 0, 500));
  const auto says = [&](const Recording& block) {
    return rejection<std::runtime_error>([&] { file.append(block); });
  };
  EXPECT_TRUE(holds(says(cut(whole, 400, 500)), "time: sample 500 is"));
  Recording broken = cut(whole, 500, 600);
  broken.columns[7].values[3] = std::nan("");
  EXPECT_TRUE(holds(says(broken), "sample 503 is nan"));
}

TEST_P(RecordingFileOf, ADefectiveRecordingIsNotWritten) {
  whole.columns[6].values[9] = std::nan("");
  EXPECT_EQ(rejection<std::runtime_error>(
                [&] { write_recording(whole, named("run")); }),
            named("run").string() +
                ": not written: true_rate: sample 9 is nan; a truth is always "
                "finite");
  EXPECT_TRUE(names().empty());
}

TEST_P(RecordingFileOf, ABlockHasTheColumnsOfTheHeadInTheirOrder) {
  RecordingFile file(whole, 1000, named("run"));
  const auto says = [&](const Recording& block) {
    return rejection<std::runtime_error>([&] { file.append(block); });
  };
  Recording block = cut(whole, 0, 10);
  block.columns.pop_back();
  EXPECT_EQ(says(block),
            named("run").string() + ": not written: 15 columns; expected 16");
  block.columns.push_back(block.columns.back());
  EXPECT_TRUE(holds(says(block),
                    "column 15 is true_ambient_temperature [degC], "
                    "truth; expected compensated_rate [degree/s], "
                    "compensated"));
  block = cut(whole, 0, 10);
  block.columns[6].role = Role::kMeasured;
  EXPECT_TRUE(holds(says(block), "column 6 is true_rate"));
}

TEST_P(RecordingFileOf, SamplesAreAsManyAsAnnounced) {
  EXPECT_TRUE(holds(rejection<std::runtime_error>(
                        [&] { RecordingFile(whole, 0, named("run")); }),
                    "no samples; expected at least one"));
  RecordingFile file(whole, 500, named("run"));
  EXPECT_TRUE(holds(
      rejection<std::runtime_error>([&] { file.append(cut(whole, 0, 501)); }),
      "501 samples; expected 500"));
  EXPECT_TRUE(holds(
      rejection<std::runtime_error>([&] { file.append(cut(whole, 0, 0)); }),
      "no samples; expected at least one"));
  file.append(cut(whole, 0, 500));
  file.finish();
  write_recording(cut(whole, 0, 500), named("whole"));
  EXPECT_EQ(read_text_file(named("run")), read_text_file(named("whole")));
}

TEST_P(RecordingFileOf, AnInterruptWhileAppendingLeavesNothing) {
  const int status = status_of_child([&] {
    std::signal(SIGINT, [](int) {
      remove_partial_files();
      _exit(130);
    });
    RecordingFile file(whole, 1000, named("run"));
    file.append(cut(whole, 0, 500));
    if (names().size() != 1) return 1;
    return std::raise(SIGINT);
  });
  EXPECT_EQ(status, 130);
  EXPECT_EQ(names().size(), 0u);
}

#ifndef BEAMGYRO_SANITIZED  // which keeps memory that was freed
TEST_P(RecordingFileOf, MemoryDoesNotGrowWithTheSamples) {
  const auto peak = [] {  // [KiB]
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  constexpr std::size_t kBlocks = 300;  // 40 MB
  RecordingFile file(whole, kBlocks * 1000, named("run"));
  const long before = peak();
  for (std::size_t i = 0; i < kBlocks; ++i) {
    file.append(whole);
    for (double& time : whole.time) time += 100;
  }
  file.finish();
  EXPECT_LT(peak() - before, 4 << 10);
  EXPECT_GT(fs::file_size(named("run")), 30u << 20);
}
#endif

INSTANTIATE_TEST_SUITE_P(Kinds, RecordingFileOf,
                         testing::Values(".h5", ".csv"));

}  // namespace
}  // namespace beamgyro::internal::recording_file_test
