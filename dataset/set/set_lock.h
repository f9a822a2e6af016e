// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "dataset/files/directory.h"
#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// Keeps other processes from the same work on a set, also on other hosts that
/// share the directory. The kernel holds the lock (flock) and releases it when
/// the process ends in any way. The file only names the holder. Where the file
/// system has no flock, the process that the file names is respected as long as
/// it lives on this host; whether a process on another host lives cannot be
/// determined.
class SetLock {
 public:
  /// Locks a set. If `task` is empty the whole set is locked against any other
  /// process. Otherwise `task` names a part, and only work on the same part or
  /// on the whole set is excluded. Throws std::runtime_error naming the host
  /// and the process that hold the lock, or the reason why locking fails, such
  /// as a lock file that is a link.
  SetLock(const std::filesystem::path& directory, const std::string& task);
  ~SetLock();  // removes the files, too
  SetLock(const SetLock&) = delete;
  SetLock& operator=(const SetLock&) = delete;

  /// Returns the process that died while it held this lock, as "host, process
  /// n", or an empty text.
  const std::string& dead_holder() const { return dead_holder_; }

  /// Returns whether the kernel holds the lock.
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
  std::string dead_holder_;
  std::optional<Held> whole_, task_;
};

}  // namespace beamgyro::internal
