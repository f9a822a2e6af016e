// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

inline constexpr const char* kManifestName = "manifest.jsonl";
/// A copy of the first line of the manifest, for the case that the manifest is
/// lost.
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

/// Runs of devices whose samples say little, though the device works.
struct CautionCounts {
  std::uint32_t unpowered = 0;   // without any power
  std::uint32_t not_locked = 0;  // in half of the powered samples or more
  std::uint32_t saturated = 0;   // in some sample
  bool operator==(const CautionCounts&) const = default;
};

/// A file of devices that is complete on the disk.
struct ManifestEntry {
  std::uint32_t index = 0;
  std::string file;  // relative to the set
  std::uint64_t bytes = 0;
  std::string sha256;
  std::uint32_t first_device = 0, devices = 0;
  std::vector<DeviceFailure> failures;
  CautionCounts cautions;
  bool operator==(const ManifestEntry&) const = default;
};

struct ManifestView {
  std::string file;  // relative to the set
  std::uint64_t bytes = 0;
  std::string sha256;
  bool operator==(const ManifestView&) const = default;
};

/// The contents of a set, or of one task's part of it: JSON lines, each with
/// its own checksum. While files are made lines are appended. At the end the
/// manifest is written again: sorted, with the head repeated and a last line
/// with the SHA-256 of all lines before. Nothing in it depends on time or
/// place.
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
/// Returns the entry that this index must have: index, file, first_device,
/// devices.
ManifestEntry expected_entry(const ManifestHead& head, std::uint32_t index);
/// Returns whether some entry of the set has a file of this name.
bool is_file_of(const ManifestHead& head, const std::string& name);
/// NAME.nc
std::string view_name(std::string_view run);
/// manifest.I-of-N.jsonl
std::string part_name(std::uint32_t task, std::uint32_t tasks);

/// Returns whether a run may have this name, from which the names of its files
/// are made: [a-z][a-z0-9_]*, 200 characters at most.
bool is_run_name(std::string_view text);

// In the functions below `name` is the name of a manifest in the directory of
// the set: kManifestName, a part or kHeadCopyName. Files are opened as by
// open_set_file() and published as by publish_file().

/// Reads a manifest. Damaged lines are left out of the result and cause no
/// error. So are lines with a name that no set has, such as one that leads out
/// of its directory. Of two lines for one index the later one counts. Throws
/// std::invalid_argument when there is no such file or it has a newer
/// format_version.
Manifest read_manifest(const std::filesystem::path& directory,
                       const std::filesystem::path& name);

/// Returns the manifest of a finished set. Throws as read_manifest(), and
/// std::invalid_argument for one that is not finished or damaged.
Manifest finished_manifest(const std::filesystem::path& directory);

/// Writes an unfinished manifest, in place of any other.
void start_manifest(const std::filesystem::path& directory,
                    const std::filesystem::path& name, const ManifestHead& head,
                    const std::vector<ManifestEntry>& entries = {});

/// Opens a file of a set to be read. Throws std::invalid_argument as
/// open_set_file(), and for a file with other bytes than `entry` says, which
/// HDF5 must not see: damage can crash it.
OpenFile open_listed(const std::filesystem::path& directory,
                     const ManifestEntry& entry);

/// Appends a line in one write, and waits until it is on the disk. Throws
/// std::runtime_error when that fails, and for a file with a second name (hard
/// link), because that may be somebody else's file.
void append_entry(const std::filesystem::path& directory,
                  const std::filesystem::path& name,
                  const ManifestEntry& entry);

/// Writes the finished manifest. `manifest` must have a head.
void write_manifest(const std::filesystem::path& directory,
                    const std::filesystem::path& name,
                    const Manifest& manifest);

}  // namespace beamgyro::internal
