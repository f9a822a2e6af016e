// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/open_file.h"

namespace beamgyro {

/// What stands under a name, which itself may be a symbolic link.
struct FileFacts {
  bool is_regular = false, is_directory = false, is_link = false;
  std::uint64_t bytes = 0, names = 0;  // hard links
};

/// An open directory, and files by names relative to it that stay below it: no
/// symbolic link is followed, neither on the way nor at the end (openat2, and
/// part by part with openat where the system has no such call). So files that
/// somebody else made lead to no others. Failures are std::system_error without
/// the name, ELOOP for a symbolic link; std::invalid_argument for a name that
/// is absolute or has "..".
class Directory {
 public:
  /// Links in `path` itself are followed.
  explicit Directory(const std::filesystem::path& path);

  int descriptor() const { return file_.descriptor(); }

  /// `flags` as of open(2).
  OpenFile open(const std::filesystem::path& name, int flags) const;

  /// Nothing when there is no such file.
  std::optional<FileFacts> find(const std::filesystem::path& name) const;

  /// A directory below, and one that is made with those above it unless it is
  /// there. An empty name is this one.
  Directory below(const std::filesystem::path& name) const;
  Directory make_below(const std::filesystem::path& name) const;

  /// Of everything in it, sorted.
  std::vector<std::string> names() const;

  /// Names from here of everything below that is no directory; links are not
  /// followed.
  std::vector<std::string> files_below() const;

  /// Nothing happens when it is not there.
  void remove(const std::string& name) const;

  /// That names in it are on the disk, where the file system can tell.
  void sync() const;

 private:
  explicit Directory(OpenFile file) : file_(std::move(file)) {}

  OpenFile file_;
};

}  // namespace beamgyro
