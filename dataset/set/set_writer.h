// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/set_lock.h"
#include "dataset/set/source_copies.h"

namespace beamgyro {

/// One of several processes that share a directory: it makes the files whose
/// index mod `of` is `number` - 1. Without `of` a process makes the whole set.
struct SetTask {
  std::uint32_t number = 0, of = 0;

  bool is_whole() const { return of == 0; }
  bool makes(std::uint32_t index) const {
    return is_whole() || index % of == number - 1;
  }
};

/// How far a set is.
struct SetState {
  std::map<std::uint32_t, ManifestEntry> entries;  // by index
  std::uint32_t planned = 0;                       // files
  bool is_merged = false;

  bool is_whole() const { return entries.size() == planned; }
  std::uint64_t device_runs() const;
  std::uint64_t failures() const;
};

/// What the manifest of a set and the parts of its tasks say together, with the
/// head they share. Throws std::invalid_argument when the directory holds no
/// set, and when the heads of its parts differ.
struct SetContents {
  ManifestHead head;
  SetState state;
};
SetContents set_contents(const std::filesystem::path& directory);

/// The same, or nothing when no manifest there has a first line.
std::optional<SetContents> find_set(const std::filesystem::path& directory);

/// A set that this process works at. While it lives no other process works at
/// the same files. A file is part of the set once a manifest has its line: that
/// of the set, or with tasks each its own. Who finds every file there merges
/// them.
class SetWriter {
 public:
  /// Makes the directory, in one that is there, locks it and copies `sources`,
  /// if any, to where the head lists them. Throws std::invalid_argument for a
  /// place that cannot hold a set, for one that holds a set of another campaign
  /// or program, and for a whole set where there are files of one, unless
  /// `resume`; std::runtime_error when another process works at the same.
  SetWriter(const std::filesystem::path& directory, ManifestHead head,
            std::span<const SourceText> sources, const SetTask& task,
            bool resume);
  ~SetWriter();

  /// Who died while working at this, empty if nobody.
  const std::string& died_before() const { return lock_->stale(); }

  /// Whether other hosts are kept from this set, too (SetLock).
  bool is_locked() const { return lock_->is_held_by_kernel(); }

  /// Files of the task that no manifest or not the directory has.
  std::vector<std::uint32_t> lacking() const;

  /// Publishes file `index` and then its line. Many threads may call it.
  void add(std::uint32_t index, std::span<const std::byte> bytes,
           const std::vector<DeviceFailure>& failures);

  /// Merges manifests and writes the views when the set is whole, and `anew`
  /// even if that was done before.
  SetState finish(bool anew = false);

 private:
  void enter(std::span<const SourceText> sources, bool resume);
  void merge(const SetState& state);

  std::filesystem::path directory_;
  std::string manifest_;  // its name
  ManifestHead head_;
  SetTask task_;
  std::optional<SetLock> lock_;
  SetState before_;
  std::mutex mutex_;
};

/// Numbers of those of `of` tasks that have files to make yet in `directory`,
/// which may be missing: "1,3-4". Throws as SetWriter for a set of another
/// campaign or program.
std::string lacking_tasks(const std::filesystem::path& directory,
                          const ManifestHead& head, std::uint32_t of);

}  // namespace beamgyro
