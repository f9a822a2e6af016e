// SPDX-License-Identifier: MIT
#include "dataset/netcdf/recording_reader.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/sample_recording.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::recording_reader_test {
namespace {

namespace fs = std::filesystem;

class Hdf5File : public DirectoryFixture {
 protected:
  const fs::path file = directory / "run.h5";
};

void expect_same_bits(const std::vector<double>& a,
                      const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a[k]),
              std::bit_cast<std::uint64_t>(b[k]));
  }
}

void expect_same(const Recording& a, const Recording& b) {
  expect_same_bits(a.time, b.time);
  EXPECT_EQ(a.status, b.status);
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    EXPECT_EQ(a.columns[i].name, b.columns[i].name);
    EXPECT_EQ(a.columns[i].units, b.columns[i].units);
    EXPECT_EQ(a.columns[i].long_name, b.columns[i].long_name);
    EXPECT_EQ(a.columns[i].role, b.columns[i].role);
    EXPECT_EQ(a.columns[i].comment, b.columns[i].comment);
    expect_same_bits(a.columns[i].values, b.columns[i].values);
  }
  EXPECT_EQ(a.fidelity, b.fidelity);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.history, b.history);
  EXPECT_EQ(a.compensator, b.compensator);
  EXPECT_EQ(a.compensator_sha256, b.compensator_sha256);
  EXPECT_EQ(a.program_version, b.program_version);
  EXPECT_EQ(a.git_revision, b.git_revision);
  EXPECT_EQ(a.scenario_text, b.scenario_text);
  EXPECT_EQ(a.device_text, b.device_text);
  EXPECT_EQ(a.overrides_text, b.overrides_text);
}

TEST_F(Hdf5File, ReadsBackWhatWasWritten) {
  for (const std::size_t samples : {1u, 2u, 7u, 5000u}) {
    Recording recording = sample_recording(samples);
    recording.overrides_text = "beam.length_m=0.038\nseed=3\n";
    recording.scenario_text += std::string(300000, 's');
    recording.columns[3].comment = "noise hides behind the resolution";
    write_recording(recording, file);
    expect_same(read_recording(file), recording);
  }
}

TEST_F(Hdf5File, ReadsBackEmptyTexts) {
  Recording recording = sample_recording(3);
  recording.fidelity.clear();
  recording.scenario_text.clear();
  recording.device_text.clear();
  recording.title.clear();
  recording.history.clear();
  recording.compensator.clear();
  recording.compensator_sha256.clear();
  recording.columns[0].name = "of_no_unit_that_is_known";
  recording.columns[0].units.clear();
  write_recording(recording, file);
  expect_same(read_recording(file), recording);
}

TEST_F(Hdf5File, ReadsBackLongTexts) {
  Recording recording = sample_recording(3);
  recording.history = std::string(5000, 'h');
  recording.title = std::string(60000, 't');
  recording.columns[2].comment = std::string(5000, 'c');
  write_recording(recording, file);
  expect_same(read_recording(file), recording);
}

TEST_F(Hdf5File, ReadsBackARecordingWithoutColumns) {
  Recording recording = sample_recording(3);
  recording.columns.clear();
  write_recording(recording, file);
  expect_same(read_recording(file), recording);
}

TEST_F(Hdf5File, EqualRecordingsMakeEqualBytesInAnyThread) {
  const Recording recording = sample_recording(2000);
  write_recording(recording, file);
  const std::string bytes = read_text_file(file);
  std::vector<std::jthread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      write_recording(recording, directory / (std::to_string(i) + ".h5"));
    });
  }
  threads.clear();
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(read_text_file(directory / (std::to_string(i) + ".h5")), bytes);
  }
}

TEST_F(Hdf5File, AMissingDirectoryIsWrongInput) {
  EXPECT_THROW(
      write_recording(sample_recording(3), directory / "no" / "run.h5"),
      std::invalid_argument);
}

// A limit on the size of files fails like a full disk, at any write.
TEST_F(Hdf5File, AFullDiskIsNoticedWhereverItStrikes) {
  const Recording old = sample_recording(4);
  write_recording(old, file);
  const Recording recording = sample_recording(3000);
  write_recording(recording, directory / "whole.h5");
  const auto whole = static_cast<rlim_t>(fs::file_size(directory / "whole.h5"));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto on_limit = std::signal(SIGXFSZ, SIG_IGN);
  int failures = 0, tries = 0;
  for (rlim_t size = 0; size < whole; size += whole / 60, ++tries) {
    rlimit limit = before;
    limit.rlim_cur = size;
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_recording(recording, file);
    } catch (const std::runtime_error& error) {
      ++failures;
      EXPECT_TRUE(holds(error.what(), "File too large"));
    }
    setrlimit(RLIMIT_FSIZE, &before);
  }
  std::signal(SIGXFSZ, on_limit);
  EXPECT_EQ(failures, tries);
  EXPECT_EQ(names().size(), 2u);
  expect_same(read_recording(file), old);
  write_recording(recording, file);
  expect_same(read_recording(file), recording);
}

}  // namespace
}  // namespace beamgyro::internal::recording_reader_test
