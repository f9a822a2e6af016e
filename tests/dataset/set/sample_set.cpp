// SPDX-License-Identifier: MIT
#include "tests/dataset/set/sample_set.h"

#include <limits>
#include <span>
#include <vector>

#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/set_view.h"
#include "dataset/set/shard/shard_builder.h"
#include "dataset/set/source_copies.h"

namespace beamgyro::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Looks like noise, and is the same everywhere.
double count_of(std::size_t k, std::uint32_t device) {
  const auto mixed = static_cast<std::uint32_t>(k) * 2654435761u;
  return static_cast<double>(mixed >> 17) - 16384.0 + device;
}

double value_of(const SetVariable& about, std::size_t k, std::uint32_t device) {
  const auto x = static_cast<double>(k);
  switch (about.storage) {
    case Storage::kInt16:
      return about.add_offset + about.scale_factor * count_of(k, device);
    case Storage::kInt32:
      return about.add_offset +
             about.scale_factor * (9.0e6 - 40.0 * x + device);
    case Storage::kFloat32:
      return static_cast<float>(25.0 + 1e-3 * x + device);
    case Storage::kFloat64:
      break;
  }
  return 0.1 * x + device;
}

ManifestEntry write_file(const std::filesystem::path& directory,
                         const ManifestHead& set, std::uint32_t index) {
  ManifestEntry entry = expected_entry(set, index);
  ShardHead head = sample_head(entry.devices, 200, 10);
  head.first_device = entry.first_device;
  head.run = set.runs[index % set.runs.size()];
  ShardBuilder builder(head);
  for (std::uint32_t i = 0; i < entry.devices; ++i) {
    const std::uint32_t device = entry.first_device + i;
    DeviceRow row = sample_row(head, device);
    const Recording recording = sample_recording_of(head, device);
    if (device == 3) {
      row.device_status = kInvalidParameters;
      row.failure = "beam.length_m: too long";
      entry.failures.push_back({device, row.failure});
    }
    builder.add(row, device == 3 ? nullptr : &recording);
  }
  const std::span<const std::byte> bytes = builder.finish();
  publish_file(directory, entry.file, bytes);
  entry.bytes = bytes.size();
  entry.sha256 = sha256(bytes);
  return entry;
}

}  // namespace

ShardHead sample_head(std::uint32_t devices, std::size_t samples,
                      std::size_t slow_step, bool compress) {
  ShardHead head;
  head.devices = devices;
  head.slow_step = slow_step;
  head.compress = compress;
  for (std::size_t k = 0; k < samples; ++k)
    head.time.push_back(static_cast<double>(k) / 10.0);
  head.variables = {
      {"output", "V", "gyro output", Role::kMeasured, Storage::kInt16,
       5.0 / 65536, 2.5},
      {"drive_frequency", "Hz", "drive frequency", Role::kMeasured,
       Storage::kInt32, 1e-3, 0},
      {"temperature", "degC", "temperature sensor", Role::kMeasured,
       Storage::kFloat32},
      {"true_rate", "degree/s", "rate about the input axis", Role::kTruth,
       Storage::kFloat64},
      {"true_bias", "degree/s", "bias", Role::kTruth, Storage::kFloat32, 1, 0,
       slow_step != 1},
  };
  head.variables[1].comment = "noise hides behind the resolution";
  head.parameters = {{"beam_length_m", "m", "length"},
                     {"patches_offset_m_0", "m", "offset"}};
  head.run = "rest";
  head.fidelity = "quasistatic";
  head.program_version = "1.2.3";
  head.git_revision = "0123abc";
  head.seed = 18446744073709551615u;  // the largest there is
  head.campaign_text = "devices = 5\n";
  head.scenario_text =
      "name = \"Gr\xc3\xbc\xc3\x9f"
      "e\"\r\n\tx = 1";
  head.device_text = "[beam]\nlength_m = 0.04\n";
  head.overrides_text = "noise.enabled=false\n";
  return head;
}

Recording sample_recording_of(const ShardHead& head, std::uint32_t device) {
  Recording recording;
  recording.time = head.time;
  const std::size_t samples = head.time.size();
  recording.status.resize(samples);
  for (std::size_t k = 0; k < samples / 5; ++k)
    recording.status[k] = kUnpowered;
  recording.status.back() = kOutputSaturated;
  for (const SetVariable& about : head.variables) {
    Column column{about.name, about.units, about.long_name, about.role, {}};
    for (std::size_t k = 0; k < samples; ++k) {
      const bool is_off = (recording.status[k] & kUnpowered) != 0;
      column.values.push_back(is_off && about.role == Role::kMeasured
                                  ? kNaN
                                  : value_of(about, k, device));
    }
    recording.columns.push_back(column);
  }
  return recording;
}

DeviceRow sample_row(const ShardHead& head, std::uint32_t device) {
  DeviceRow row;
  for (std::size_t p = 0; p < head.parameters.size(); ++p)
    row.parameters.push_back(0.04 + 0.001 * device + static_cast<double>(p));
  row.part = static_cast<std::uint8_t>(device % 3);
  return row;
}

Manifest write_sample_set(const std::filesystem::path& directory) {
  ManifestHead set;
  const SourceText campaign{"/work place/campaign.toml", "devices = 5\n"};
  set.campaign = "source/campaign.toml";
  set.campaign_sha256 = sha256(campaign.text);
  set.program_version = "1.2.3";
  set.git_revision = "0123abc";
  set.seed = 18446744073709551615u;
  set.devices = 5;
  set.devices_per_file = 2;
  set.runs = {"rest", "warm_up"};
  set.sources = source_entries(std::span(&campaign, 1));
  copy_sources(directory, std::span(&campaign, 1));
  Manifest manifest;
  manifest.head = set;
  manifest.is_finished = true;
  for (std::uint32_t index = 0; index < file_count(set); ++index)
    manifest.entries.push_back(write_file(directory, set, index));
  for (std::size_t run = 0; run < set.runs.size(); ++run) {
    ShardHead head = sample_head(2, 200, 10);
    head.run = set.runs[run];
    std::vector<ManifestEntry> entries;
    for (std::size_t i = run; i < manifest.entries.size(); i += 2)
      entries.push_back(manifest.entries[i]);
    manifest.views.push_back(write_view(directory, head, entries));
  }
  start_manifest(directory, kHeadCopyName, *manifest.head);
  write_manifest(directory, kManifestName, manifest);
  return manifest;
}

}  // namespace beamgyro::internal
