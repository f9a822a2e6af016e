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

namespace beamgyro::internal {

/// One of several processes that share a directory: it makes the files whose
/// index mod `of` is `number` - 1. Without `of` a process makes the whole set.
struct SetTask {
  std::uint32_t number = 0, of = 0;

  bool is_whole() const { return of == 0; }
  bool makes(std::uint32_t index) const {
    return is_whole() || index % of == number - 1;
  }
};

/// Progress of a set.
struct SetState {
  std::map<std::uint32_t, ManifestEntry> entries;  // by index
  std::uint32_t planned = 0;                       // files
  bool is_merged = false;

  bool is_whole() const { return entries.size() == planned; }
  std::uint64_t device_runs() const;
  std::uint64_t failures() const;
  CautionCounts cautions() const;
};

/// Returns a sentence for each caution that counts device runs of the set.
std::vector<std::string> caution_texts(const SetState& state);

/// Returns whether no device of a set has values in any run, and one line that
/// says so with the first reason.
bool every_device_failed(const SetState& state);
std::string every_device_failed_text(const SetState& state);

/// Contents of the manifest of a set and of the parts of its tasks together,
/// with their common head. Throws std::invalid_argument when the directory is
/// no set, and when the heads of its parts differ.
struct SetContents {
  ManifestHead head;
  SetState state;
};
SetContents set_contents(const std::filesystem::path& directory);

/// Returns the same, or nothing when no manifest there has a first line.
std::optional<SetContents> find_set(const std::filesystem::path& directory);

/// A set that this process adds files to. While the object lives no other
/// process makes the same files. A file is part of the set once a manifest has
/// its line: the manifest of the set or, with tasks, that of the task. The
/// process that finds every file present merges the manifests.
class SetWriter {
 public:
  /// Makes the directory (its parent must exist), locks it, and copies
  /// `sources`, if any, to the names in the head.
  /// - Throws std::invalid_argument for a place that cannot hold a set, and for
  ///   one that holds a set of another campaign or program.
  /// - Throws std::invalid_argument for a whole set where there are files of
  ///   one, unless `resume`.
  /// - Throws std::runtime_error when another process works on the same.
  SetWriter(const std::filesystem::path& directory, ManifestHead head,
            std::span<const SourceText> sources, const SetTask& task,
            bool resume);
  ~SetWriter();

  /// Returns the process that died while working on this, or an empty text.
  const std::string& died_before() const { return lock_->dead_holder(); }

  /// Returns whether the lock also excludes other hosts (SetLock).
  bool is_locked() const { return lock_->is_held_by_kernel(); }

  /// Returns the files of the task that are missing from the manifests or from
  /// the directory.
  std::vector<std::uint32_t> lacking() const;

  /// Publishes file `index` and then its line. Safe to call from many threads.
  void add(std::uint32_t index, std::span<const std::byte> bytes,
           const std::vector<DeviceFailure>& failures,
           const CautionCounts& cautions = {});

  /// Merges manifests and writes the views when the set is complete; with
  /// `anew` even if that was done before.
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

/// Returns the numbers of the tasks, of `of`, that have files left to make in
/// `directory`, as "1,3-4". The directory may be missing. Throws as SetWriter
/// for a set of another campaign or program.
std::string lacking_tasks(const std::filesystem::path& directory,
                          const ManifestHead& head, std::uint32_t of);

}  // namespace beamgyro::internal
