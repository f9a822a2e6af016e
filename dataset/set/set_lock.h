// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dataset/open_file.h"

namespace beamgyro {

/// Keeps other processes, on hosts that share the directory too, from the same
/// work on a set. The kernel holds the lock (flock) and lets go when the
/// process ends in any way; the file only says who it is.
class SetLock {
 public:
  /// `task`: empty for work on the whole set, which no other process may do
  /// anything to then; else the name of a part, which only excludes the same
  /// part and work on the whole. Throws std::runtime_error naming host and
  /// process that hold it, or why locking fails.
  SetLock(const std::filesystem::path& directory, const std::string& task);
  ~SetLock();  // removes the files, too
  SetLock(const SetLock&) = delete;
  SetLock& operator=(const SetLock&) = delete;

  /// Who died with this lock before, as "host, process n"; empty if nobody.
  const std::string& stale() const { return stale_; }

 private:
  struct Held {
    std::filesystem::path path;
    OpenFile file;
  };

  Held acquire(const std::filesystem::path& path, int operation);
  static void release(Held& held) noexcept;

  std::string stale_;
  std::optional<Held> whole_, task_;
};

}  // namespace beamgyro
