// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dataset/files/open_file.h"
#include "dataset/recording/recording.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {

/// Returns whether `path` is an HDF5 file with the file type of a set.
bool is_shard_file(const std::filesystem::path& path);

/// An open file of a set. Every call throws std::invalid_argument naming the
/// file when it is missing, damaged, not HDF5, no file of a set, of a newer
/// format_version, or has content with a defect. Only a comparison with the
/// manifest finds all damage (check_set()).
class ShardFile {
 public:
  explicit ShardFile(const std::filesystem::path& path);
  /// Opens a file of a set that may come from somebody else: an ordinary file
  /// of that name in its directory, as open_set_file().
  ShardFile(const std::filesystem::path& directory, const std::string& name);
  /// Of an open file that is called `path` in messages.
  ShardFile(const std::filesystem::path& path, OpenFile file);
  ~ShardFile();
  ShardFile(const ShardFile&) = delete;
  ShardFile& operator=(const ShardFile&) = delete;

  const ShardHead& head() const;
  std::uint32_t devices() const { return head().devices; }

  /// Returns the row at `position` in the file, from 0. Throws
  /// std::out_of_range beyond it.
  const DeviceRow& row(std::uint32_t position) const;

  /// Reads one device without its slow variables, in the form of
  /// read_recording(). Reads nothing of the others, and of `variables`, where
  /// there are any, only these. Throws std::invalid_argument for a device that
  /// failed.
  Recording recording(std::uint32_t position,
                      const std::vector<std::string>& variables = {}) const;

  /// The same for the slow variables, over truth_time.
  Recording slow_recording(std::uint32_t position) const;

 private:
  class File;

  Recording read(std::uint32_t position, bool slow,
                 const std::vector<std::string>& variables) const;

  std::filesystem::path path_;
  std::unique_ptr<File> file_;
};

}  // namespace beamgyro::internal
