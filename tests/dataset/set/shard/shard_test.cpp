// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "dataset/files/atomic_file.h"
#include "dataset/files/set_files.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/recording_file.h"
#include "dataset/set/shard/shard_builder.h"
#include "dataset/set/shard/shard_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::shard_test {
namespace {

class Shard : public DirectoryFixture {
 protected:
  std::filesystem::path file() const { return directory / "rest_00000.h5"; }

  void write(const ShardHead& head) const {
    ShardBuilder builder(head);
    for (std::uint32_t i = 0; i < head.devices; ++i) {
      const Recording recording = sample_recording_of(head, i);
      builder.add(sample_row(head, i), &recording);
    }
    publish_file(directory, file().filename(), builder.finish());
  }

  /// Writes one device with `change` made to its recording.
  template <class Change>
  static std::string refusal(const Change& change) {
    ShardHead head = sample_head(1, 100);
    head.first_device = 40;
    ShardBuilder builder(head);
    Recording recording = sample_recording_of(head, 40);
    change(recording);
    return rejection<std::runtime_error>(
        [&] { builder.add(sample_row(head, 0), &recording); });
  }
};

void expect_close(const std::vector<double>& found,
                  const std::vector<double>& expected,
                  const std::string& name) {
  ASSERT_EQ(found.size(), expected.size()) << name;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (std::isnan(expected[k])) {
      ASSERT_TRUE(std::isnan(found[k])) << name << ' ' << k;
    } else {
      ASSERT_NEAR(found[k], expected[k], 1e-12 * std::abs(expected[k]))
          << name << ' ' << k;
    }
  }
}

void expect_same(const Recording& found, const Recording& expected,
                 const ShardHead& head) {
  EXPECT_EQ(found.time, expected.time);
  EXPECT_EQ(found.status, expected.status);
  for (const SetVariable& about : head.variables) {
    if (about.slow) continue;
    const Column* column = find_column(found, about.name);
    ASSERT_NE(column, nullptr) << about.name;
    EXPECT_EQ(column->units, about.units);
    EXPECT_EQ(column->long_name, about.long_name);
    EXPECT_EQ(column->role, about.role);
    expect_close(column->values, column_values(expected, about.name),
                 about.name);
  }
}

TEST_F(Shard, GivesBackEveryDeviceWhetherCompressedOrNot) {
  for (const bool compress : {true, false}) {
    for (const std::size_t samples : {1u, 7u, 1000u}) {
      const ShardHead head = sample_head(3, samples, 1, compress);
      write(head);
      const ShardFile read(file());
      ASSERT_EQ(read.devices(), 3u);
      EXPECT_EQ(read.head().compress, compress);
      for (std::uint32_t i = 0; i < 3; ++i) {
        expect_same(read.recording(i), sample_recording_of(head, i), head);
        EXPECT_EQ(read.row(i).parameters, sample_row(head, i).parameters);
        EXPECT_EQ(read.row(i).part, i);
        EXPECT_EQ(read.row(i).device_status, kDeviceOk);
      }
    }
  }
}

TEST_F(Shard, GivesBackItsHead) {
  ShardHead head = sample_head(2, 95, 10);
  head.first_device = 4000000000u;
  write(head);
  const ShardFile read(file());
  const ShardHead& found = read.head();
  EXPECT_EQ(found.first_device, head.first_device);
  EXPECT_EQ(found.time, head.time);
  EXPECT_EQ(found.slow_step, head.slow_step);
  EXPECT_EQ(found.run, head.run);
  EXPECT_EQ(found.fidelity, head.fidelity);
  EXPECT_EQ(found.program_version, head.program_version);
  EXPECT_EQ(found.git_revision, head.git_revision);
  EXPECT_EQ(found.seed, head.seed);
  EXPECT_EQ(found.campaign_text, head.campaign_text);
  EXPECT_EQ(found.scenario_text, head.scenario_text);
  EXPECT_EQ(found.device_text, head.device_text);
  EXPECT_EQ(found.overrides_text, head.overrides_text);
  ASSERT_EQ(found.variables.size(), head.variables.size());
  for (std::size_t i = 0; i < found.variables.size(); ++i) {
    EXPECT_EQ(found.variables[i].storage, head.variables[i].storage);
    EXPECT_EQ(found.variables[i].slow, head.variables[i].slow);
    EXPECT_EQ(found.variables[i].scale_factor, head.variables[i].scale_factor);
    EXPECT_EQ(found.variables[i].add_offset, head.variables[i].add_offset);
    EXPECT_EQ(found.variables[i].comment, head.variables[i].comment);
  }
  ASSERT_EQ(found.parameters.size(), 2u);
  EXPECT_EQ(found.parameters[1].name, "patches_offset_m_0");
  EXPECT_EQ(found.parameters[1].long_name, "offset");
}

TEST_F(Shard, SlowVariablesAreEveryTenthSample) {
  const ShardHead head = sample_head(2, 95, 10);
  write(head);
  const ShardFile read(file());
  EXPECT_EQ(find_column(read.recording(1), "true_bias"), nullptr);
  const Recording slow = read.slow_recording(1);
  ASSERT_EQ(slow.columns.size(), 1u);
  const Recording whole = sample_recording_of(head, 1);
  ASSERT_EQ(slow.time.size(), 10u);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_EQ(slow.time[k], head.time[10 * k]);
    EXPECT_EQ(slow.status[k], whole.status[10 * k]);
    EXPECT_EQ(slow.columns[0].values[k],
              column_values(whole, "true_bias")[10 * k]);
  }
}

TEST_F(Shard, LongRunsAreCutIntoEqualChunks) {
  EXPECT_EQ(chunk_length(1), 1u);
  EXPECT_EQ(chunk_length(131072), 131072u);
  EXPECT_EQ(chunk_length(131073), 65537u);
  const ShardHead head = sample_head(2, 131073);
  write(head);
  expect_same(ShardFile(file()).recording(1), sample_recording_of(head, 1),
              head);
}

TEST_F(Shard, AFailedDeviceHasAReasonAndNoValues) {
  ShardHead head = sample_head(2, 100);
  head.first_device = 6;
  ShardBuilder builder(head);
  const Recording recording = sample_recording_of(head, 6);
  builder.add(sample_row(head, 6), &recording);
  DeviceRow row = sample_row(head, 7);
  row.failure = "no convergence at \"25 degC\"\nin line 2";
  row.device_status = kNoConvergence;
  builder.add(row, nullptr);
  publish_file(directory, file().filename(), builder.finish());
  const ShardFile read(file());
  expect_same(read.recording(0), recording, head);
  EXPECT_EQ(read.row(0).failure, "");
  EXPECT_EQ(read.row(1).failure, row.failure);
  EXPECT_EQ(read.row(1).device_status, kNoConvergence);
  EXPECT_EQ(read.row(1).parameters, row.parameters);
  EXPECT_EQ(rejection([&] { read.recording(1); }),
            file().string() + ": device 7 has no values: " + row.failure);
  EXPECT_THROW(read.recording(2), std::out_of_range);
}

TEST_F(Shard, BytesDependNeitherOnThreadsNorOnTheOrderOfEncoding) {
  const ShardHead head = sample_head(4, 3000, 10);
  write(head);
  ShardBuilder builder(head);
  std::vector<EncodedDevice> devices(4);
  std::vector<std::jthread> threads;
  for (std::uint32_t i = 4; i-- > 0;) {
    threads.emplace_back([&, i] {
      const Recording recording = sample_recording_of(head, i);
      devices[i] = builder.encode(i, sample_row(head, i), &recording);
    });
  }
  threads.clear();
  for (const EncodedDevice& device : devices) builder.add(device);
  const auto bytes = builder.finish();
  EXPECT_EQ(
      std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
      read_text_file(file()));
}

TEST_F(Shard, FilesOfSeveralThreadsDoNotMeet) {
  const ShardHead head = sample_head(2, 500);
  write(head);
  const std::string expected = read_text_file(file());
  std::vector<std::string> made(8);
  {
    std::vector<std::jthread> threads;
    for (std::string& text : made) {
      threads.emplace_back([&] {
        ShardBuilder builder(head);
        for (std::uint32_t i = 0; i < 2; ++i) {
          const Recording recording = sample_recording_of(head, i);
          builder.add(sample_row(head, i), &recording);
        }
        const auto bytes = builder.finish();
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      });
    }
  }
  for (const std::string& text : made) EXPECT_TRUE(text == expected);
}

TEST_F(Shard, TheLowestConverterCodeIsNotTheFillValue) {
  const ShardHead head = sample_head(1, 10);
  Recording recording = sample_recording_of(head, 0);
  recording.columns[0].values[5] = 2.5 - 2.5;  // count -32768
  ShardBuilder builder(head);
  builder.add(sample_row(head, 0), &recording);
  publish_file(directory, file().filename(), builder.finish());
  EXPECT_EQ(ShardFile(file()).recording(0).columns[0].values[5],
            2.5 - 32767 * (5.0 / 65536));
}

TEST_F(Shard, ValuesThatDoNotFitAreNamed) {
  using ::testing::HasSubstr;
  EXPECT_THAT(
      refusal([](Recording& r) { r.columns[0].values[30] += 1e-9; }),
      AllOf(HasSubstr("device 40, run rest: output: sample 30 is "),
            HasSubstr("; expected 2.5 + a whole number of 7.62939453125e-05 "
                      "from -32767 to 32767")));
  EXPECT_THAT(refusal([](Recording& r) { r.columns[0].values[31] = 5.0; }),
              HasSubstr("output: sample 31 is 5; expected 2.5 + a whole"));
  EXPECT_THAT(
      refusal([](Recording& r) { r.columns[1].values[32] = -2147483.648; }),
      HasSubstr("drive_frequency: sample 32 is -2147483.648; expected"));
  EXPECT_THAT(refusal([](Recording& r) { r.columns[1].values[33] = 1e300; }),
              HasSubstr("drive_frequency: sample 33 is 1e+300; expected"));
  EXPECT_THAT(refusal([](Recording& r) { r.columns[2].values[34] = 1e39; }),
              HasSubstr("temperature: sample 34 is 1e+39; expected at most"));
}

TEST_F(Shard, RecordingsWithADefectAreRefused) {
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal([](Recording& r) { r.columns[0].values[50] = NAN; }),
              HasSubstr("device 40, run rest: output: sample 50 is nan while "
                        "powered"));
  EXPECT_THAT(refusal([](Recording& r) { r.columns.erase(r.columns.begin()); }),
              HasSubstr("output is missing"));
  EXPECT_THAT(refusal([](Recording& r) { r.time[3] += 0.01; }),
              HasSubstr("the times are not those of the file"));
  EXPECT_THAT(refusal([](Recording& r) { r.status.pop_back(); }),
              HasSubstr("status: 99 values for 100 times"));
}

TEST_F(Shard, HeadsWithADefectAreRefused) {
  const auto refused = [](const auto& change) {
    ShardHead head = sample_head(1, 10);
    change(head);
    return rejection<std::runtime_error>([&] { ShardBuilder{head}; });
  };
  EXPECT_EQ(refused([](ShardHead& h) { h.parameters[0].name = "output"; }),
            "output: the name is taken");
  EXPECT_EQ(refused([](ShardHead& h) { h.variables[0].name = "part"; }),
            "part: the name is taken");
  EXPECT_EQ(refused([](ShardHead& h) { h.devices = 0; }),
            "no devices; expected at least one");
  EXPECT_EQ(refused([](ShardHead& h) { h.variables[0].scale_factor = 0; }),
            "output: scale factor 0 and offset 2.5");
  EXPECT_EQ(refused([](ShardHead& h) { h.slow_step = 0; }),
            "a slow step of 0; expected at least 1");
  EXPECT_EQ(refused([](ShardHead& h) { h.time.clear(); }),
            "time: no samples; expected at least one");
}

TEST_F(Shard, EveryDeviceHasToBeThere) {
  const ShardHead head = sample_head(1, 10);
  ShardBuilder builder(head);
  EXPECT_EQ(rejection<std::runtime_error>([&] { builder.finish(); }),
            "0 devices; expected 1");
  const Recording recording = sample_recording_of(head, 0);
  DeviceRow row = sample_row(head, 0);
  row.failure = "why";
  EXPECT_THROW(builder.add(row, &recording), std::runtime_error);
  EXPECT_THROW(builder.add(sample_row(head, 0), nullptr), std::runtime_error);
  builder.add(sample_row(head, 0), &recording);
  EXPECT_EQ(rejection<std::runtime_error>(
                [&] { builder.add(sample_row(head, 0), &recording); }),
            "more devices than 1");
}

// HDF5 checks the sum that we wrote.
TEST_F(Shard, AFlippedBitInTheValuesIsNoticed) {
  const ShardHead head = sample_head(1, 4000);
  write(head);
  const Recording recording = sample_recording_of(head, 0);
  std::string bytes = read_text_file(file());
  ShardBuilder builder(head);
  const EncodedDevice device =
      builder.encode(0, sample_row(head, 0), &recording);
  for (const auto& chunks : device.variables) {
    const std::string chunk(
        reinterpret_cast<const char*>(chunks.front().bytes.data()),
        chunks.front().bytes.size());
    const std::size_t place = bytes.find(chunk);
    ASSERT_NE(place, std::string::npos);
    for (const std::size_t at :
         {std::size_t{0}, chunk.size() / 2, chunk.size() - 1}) {
      std::string flipped = bytes;
      flipped[place + at] = static_cast<char>(flipped[place + at] ^ 4);
      write_text_file(file(), flipped);
      EXPECT_THROW(ShardFile(file()).recording(0), std::invalid_argument);
    }
  }
}

TEST_F(Shard, OtherFilesAreRejected) {
  EXPECT_EQ(rejection([&] { ShardFile{file()}; }),
            file().string() + ": cannot read: No such file or directory");
  EXPECT_EQ(rejection([&] { ShardFile{directory}; }),
            directory.string() +
                ": not a file; expected a file of a set of "
                "beamgyro");
  write_text_file(file(), "devices = 5");
  EXPECT_EQ(rejection([&] { ShardFile{file()}; }),
            file().string() +
                ": not an HDF5 file; expected a file of a set of "
                "beamgyro");
  const ShardHead head = sample_head(1, 10);
  write_recording(sample_recording_of(head, 0), file());
  EXPECT_EQ(rejection([&] { ShardFile{file()}; }),
            file().string() +
                ": not a file of a set of beamgyro; expected the attribute "
                "filetype = \"beamgyro-set\"");
}

}  // namespace
}  // namespace beamgyro::internal::shard_test
