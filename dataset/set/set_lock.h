// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dataset/directory.h"
#include "dataset/open_file.h"

namespace beamgyro {

/// Keeps other processes, on hosts that share the directory too, from the same
/// work on a set. The kernel holds the lock (flock) and lets go when the
/// process ends in any way; the file only says who it is. Where the file system
/// knows no flock only that is left: who is named and lives on this host is
/// respected, and whether one on another host does cannot be told.
class SetLock {
 public:
  /// `task`: empty for work on the whole set, which no other process may do
  /// anything to then; else the name of a part, which only excludes the same
  /// part and work on the whole. Throws std::runtime_error naming host and
  /// process that hold it, or why locking fails, as for a lock that is a link.
  SetLock(const std::filesystem::path& directory, const std::string& task);
  ~SetLock();  // removes the files, too
  SetLock(const SetLock&) = delete;
  SetLock& operator=(const SetLock&) = delete;

  /// Who died with this lock before, as "host, process n"; empty if nobody.
  const std::string& stale() const { return stale_; }

  /// Whether the kernel holds the lock.
  bool is_held_by_kernel() const { return whole_->by_kernel; }

 private:
  struct Held {
    std::string name;
    OpenFile file;
    bool by_kernel;
  };

  static Directory opened(const std::filesystem::path& directory);
  Held acquire(const std::string& name, int operation);
  void release(Held& held) const noexcept;
  [[noreturn]] void fail(const std::string& name, const std::string& why) const;
  [[noreturn]] void refuse(const std::string& who) const;
  OpenFile open_lock(const std::string& name) const;
  bool is_current(const std::string& name, const OpenFile& file) const;
  void respect_the_living(const OpenFile& file) const;

  std::filesystem::path path_;
  Directory directory_;
  std::string stale_;
  std::optional<Held> whole_, task_;
};

}  // namespace beamgyro
