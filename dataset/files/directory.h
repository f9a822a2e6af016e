// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// Facts about the file of a name, which itself may be a symbolic link.
struct FileFacts {
  bool is_regular = false, is_directory = false, is_link = false;
  std::uint64_t bytes = 0, names = 0;  // hard links
};

/// An open directory. Names are relative to it and stay below it: no symbolic
/// link is followed, neither on the way nor at the end (openat2, or part by
/// part with openat where the system has no such call). So a directory that
/// somebody else made cannot lead to files elsewhere. Failures are
/// std::system_error without the name, with ELOOP for a symbolic link. A name
/// that is absolute or contains ".." throws std::invalid_argument.
class Directory {
 public:
  /// Opens a directory. Links in `path` itself are followed.
  explicit Directory(const std::filesystem::path& path);

  int descriptor() const { return file_.descriptor(); }

  /// Opens a file; `flags` are those of open(2).
  OpenFile open(const std::filesystem::path& name, int flags) const;

  /// Returns the facts about a file, or nothing when there is no such file.
  std::optional<FileFacts> find(const std::filesystem::path& name) const;

  /// Opens a directory below this one. make_subdirectory() makes it, and those
  /// above it, unless it is there. An empty name means this directory.
  Directory subdirectory(const std::filesystem::path& name) const;
  Directory make_subdirectory(const std::filesystem::path& name) const;

  /// Returns the names of all entries, sorted.
  std::vector<std::string> names() const;

  /// Returns the relative names of all files below that are not directories.
  /// Links are not followed.
  std::vector<std::string> files_below() const;

  /// Removes a file. Does nothing if there is none.
  void remove(const std::string& name) const;

  /// Synchronises the names in the directory with the disk, where the file
  /// system can do that.
  void sync() const;

 private:
  explicit Directory(OpenFile file) : file_(std::move(file)) {}

  OpenFile file_;
};

/// Makes a directory and those above it that are missing. The destructor
/// removes those that were made and are empty, so that a failure leaves none.
class MadeDirectories {
 public:
  /// Throws as throw_file_error() when they cannot be made, and
  /// std::invalid_argument when `path` is there and is no directory.
  explicit MadeDirectories(const std::filesystem::path& path);
  ~MadeDirectories() { remove_empty(); }
  MadeDirectories(const MadeDirectories&) = delete;
  MadeDirectories& operator=(const MadeDirectories&) = delete;

 private:
  void remove_empty() noexcept;

  std::vector<std::filesystem::path> made_;  // outer ones first
};

/// Which file a path names, and when it was last written or moved. A file that
/// is replaced, and replaced back, has another state than before.
struct FileState {
  dev_t device = 0;
  ino_t number = 0;
  off_t size = 0;               // [bytes]
  std::array<long, 4> times{};  // st_mtim and st_ctim: [s], [ns] of each

  bool operator==(const FileState&) const = default;
};

/// Returns the state of a file, through links; of one that is not there zeros.
FileState state_of_file(const std::filesystem::path& path);

}  // namespace beamgyro::internal
