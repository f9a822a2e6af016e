// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro {

inline constexpr const char* kManifestName = "manifest.jsonl";
/// A manifest with a head alone, for when the other is lost.
inline constexpr const char* kHeadCopyName = "source/head.jsonl";

/// A file of the set that the campaign read, below source/.
struct SourceEntry {
  std::string file;  // relative to the set: source/...
  std::string sha256;
  bool operator==(const SourceEntry&) const = default;
};

struct ManifestHead {
  std::string campaign;  // its file's name, one of the sources
  std::string campaign_sha256, program_version, git_revision;
  std::uint64_t seed = 0;
  std::uint32_t devices = 0, devices_per_file = 1;
  std::vector<std::string> runs;
  std::vector<SourceEntry> sources;
  bool operator==(const ManifestHead&) const = default;
};

struct DeviceFailure {
  std::uint32_t device = 0;
  std::string reason;
  bool operator==(const DeviceFailure&) const = default;
};

/// A file of devices that is whole on the disk.
struct ManifestEntry {
  std::uint32_t index = 0;
  std::string file;  // relative to the set
  std::uint64_t bytes = 0;
  std::string sha256;
  std::uint32_t first_device = 0, devices = 0;
  std::vector<DeviceFailure> failures;
  bool operator==(const ManifestEntry&) const = default;
};

struct ManifestView {
  std::string file;  // relative to the set
  std::uint64_t bytes = 0;
  std::string sha256;
  bool operator==(const ManifestView&) const = default;
};

/// What a set, or one task's part of it, holds: JSON lines, each with a
/// checksum of its own. While files are made lines are appended; at the end the
/// whole is written anew, sorted, with the head again and a last line with the
/// SHA-256 of all before. Nothing in it tells of time or place.
struct Manifest {
  std::optional<ManifestHead> head;
  std::vector<ManifestEntry> entries;  // by index, none twice
  std::vector<ManifestView> views;
  bool is_finished = false;                // the last line is there
  std::vector<std::size_t> damaged_lines;  // from 1; a line cut short at the
                                           // end of an unfinished one is none
};

/// Range and run of a file of the set; index = range * runs + run.
std::uint32_t file_count(const ManifestHead& head);
/// What the entry of this index has to say: index, file, first_device, devices.
ManifestEntry expected_entry(const ManifestHead& head, std::uint32_t index);
/// NAME.nc
std::string view_name(std::string_view run);
/// manifest.I-of-N.jsonl
std::string part_name(std::uint32_t task, std::uint32_t tasks);

/// Never fails for what the file says: what is damaged is not in the result.
/// Of two lines for one index the later one counts. Throws
/// std::invalid_argument when there is no such file or it is of a newer
/// format_version.
Manifest read_manifest(const std::filesystem::path& path);

/// An unfinished manifest, in place of any other.
void start_manifest(const std::filesystem::path& path, const ManifestHead& head,
                    const std::vector<ManifestEntry>& entries = {});

/// Adds a line in one write, and waits until it is on the disk. Throws
/// std::runtime_error when that fails.
void append_entry(const std::filesystem::path& path,
                  const ManifestEntry& entry);

/// The finished manifest of `manifest`, which has a head.
void write_manifest(const std::filesystem::path& path,
                    const Manifest& manifest);

}  // namespace beamgyro
