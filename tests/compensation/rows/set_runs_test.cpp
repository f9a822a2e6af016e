// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>

#include "compensation/rows/run_source.h"
#include "compensation/training/train.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard_builder.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_runs_test {
namespace {

constexpr std::uint32_t kDevices = 6, kPerFile = 4;

// The bias tells device and run: device 10 k, second run 0.5 more.
Recording recording_of(std::uint32_t device, std::size_t run) {
  RecordedRun gyro{.duration = 300.0, .step = 1.0};
  gyro.bias = [=](double) {
    return 10.0 * device + 0.5 * static_cast<double>(run);
  };
  return gyro.recording();
}

// Devices 0, 1 and 4 train, 2 validates, 3 tests, 5 failed.
DeviceRow row_of(std::uint32_t device) {
  constexpr std::uint8_t kParts[] = {0, 0, 1, 2, 0, 0};
  DeviceRow row;
  row.part = kParts[device];
  if (device == 5) {
    row.failure = "no equilibrium";
    row.device_status = kNoConvergence;
  }
  return row;
}

class SetRuns : public DirectoryFixture {
 protected:
  SetRuns() {
    manifest_.head = ManifestHead{};
    manifest_.head->devices = kDevices;
    manifest_.head->devices_per_file = kPerFile;
    manifest_.head->runs = {"soaks", "ramp"};
    manifest_.head->sources = {{"source/campaign.toml", "abc"}};
    for (std::uint32_t index = 0; index < file_count(*manifest_.head); ++index)
      manifest_.entries.push_back(write_file(index));
    write_manifest(directory, kManifestName, manifest_);
  }
  ManifestEntry write_file(std::uint32_t index) const {
    ManifestEntry entry = expected_entry(*manifest_.head, index);
    const std::size_t run = index % 2;
    const Recording like = recording_of(0, run);
    ShardHead head;
    head.first_device = entry.first_device;
    head.devices = entry.devices;
    head.time = like.time;
    for (const Column& column : like.columns)
      head.variables.push_back({column.name, column.units, column.long_name,
                                column.role, Storage::kFloat64});
    head.run = manifest_.head->runs[run];
    head.fidelity = "quasistatic";
    ShardBuilder builder(head);
    for (std::uint32_t k = 0; k < entry.devices; ++k) {
      const std::uint32_t device = entry.first_device + k;
      const Recording recording = recording_of(device, run);
      const DeviceRow row = row_of(device);
      builder.add(row, row.failure.empty() ? &recording : nullptr);
    }
    const auto bytes = builder.finish();
    entry.bytes = bytes.size();
    publish_file(directory, entry.file, bytes);
    entry.sha256 = sha256_of_file(directory / entry.file);
    return entry;
  }

  // First bias of each run visited.
  std::vector<double> biases(const SetSelection& selection) const {
    const RunSource source = runs_of_set(directory, selection);
    std::vector<double> found;
    source.for_each([&](const TrainingRun& run) {
      found.push_back(column_values(run.recording, "rate")[0]);
      EXPECT_TRUE(run.sha256.empty());
    });
    EXPECT_EQ(source.count, found.size());
    return found;
  }

  Manifest manifest_;
};

TEST_F(SetRuns, ComeByPartRunAndDevice) {
  using Biases = std::vector<double>;
  EXPECT_EQ(biases({SetPartNumber::kTrain}),
            (Biases{0.0, 10.0, 0.5, 10.5, 40.0, 40.5}));
  EXPECT_EQ(biases({SetPartNumber::kValidation}), (Biases{20.0, 20.5}));
  EXPECT_EQ(biases({SetPartNumber::kTest, {"ramp"}}), (Biases{30.5}));
  EXPECT_EQ(biases({{}, {"soaks"}, {3, 4}}), (Biases{30.0, 40.0}));
  EXPECT_EQ(biases({{}, {}, {5}}), (Biases{}));  // it failed
}

TEST_F(SetRuns, RowsKnowTheirDeviceAndTheProvenanceTheManifest) {
  const ModelSpec spec{.inputs = {parse_input("temperature")},
                       .kind = ConstantSpec{}};
  const RunSource training = runs_of_set(directory, {SetPartNumber::kTrain});
  const TrainingRows rows = training_rows(training, spec.inputs, spec.rows);
  ASSERT_EQ(rows.size(), 6 * 5);               // minutes
  EXPECT_EQ(rows.device(0), rows.device(10));  // device 0 in both runs
  EXPECT_NE(rows.device(0), rows.device(5));
  EXPECT_EQ(rows.device.maxCoeff(), 2);
  const Provenance p =
      train(spec, training,
            runs_of_set(directory, {SetPartNumber::kValidation}), 1)
          .compensator.provenance;
  EXPECT_TRUE(p.training.empty());
  ASSERT_TRUE(p.training_set && p.held_out_set);
  EXPECT_EQ(*p.training_set,
            (TrainingSet{directory.filename().string(),
                         sha256_of_file(directory / kManifestName),
                         3,
                         4,
                         "",
                         0,
                         {"soaks", "ramp"},
                         {0, 1, 4}}));
  EXPECT_EQ(p.held_out_set->devices, 1u);
  EXPECT_NEAR(*p.held_out_rms, 20.25 - (0.25 + 50.0 / 3.0), 0.1);
}

TEST_F(SetRuns, RefuseFilesThatAreNotWhatTheManifestSays) {
  const auto message = [&](const SetSelection& selection) {
    return rejection([&] { runs_of_set(directory, selection); });
  };
  // Whole, of the same devices, and of the other run.
  std::filesystem::copy_file(directory / manifest_.entries[1].file,
                             directory / manifest_.entries[0].file,
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(
      holds(message({{}, {"soaks"}}), "other bytes than the manifest says"));
  EXPECT_EQ(biases({{}, {"ramp"}, {0}}), std::vector<double>{0.5});
  manifest_.entries.pop_back();
  write_manifest(directory, kManifestName, manifest_);
  EXPECT_TRUE(holds(message({{}, {"ramp"}}), "the manifest is damaged"));
}

TEST_F(SetRuns, RefuseWhatTheSetDoesNotHave) {
  const auto message = [&](const SetSelection& selection) {
    return rejection([&] { runs_of_set(directory, selection); });
  };
  EXPECT_TRUE(holds(message({{}, {"warm_up"}}),
                    "no run \"warm_up\"; its runs are soaks, ramp"));
  EXPECT_TRUE(holds(message({{}, {}, {6}}), "the set has devices 0 to 5"));
  start_manifest(directory, kManifestName, *manifest_.head);
  EXPECT_TRUE(holds(message({}), "the set is not finished"));
  std::filesystem::remove(directory / kManifestName);
  EXPECT_TRUE(holds(message({}), "holds no set"));
}

}  // namespace
}  // namespace beamgyro::internal::set_runs_test
