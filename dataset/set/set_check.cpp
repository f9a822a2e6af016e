// SPDX-License-Identifier: MIT
#include "dataset/set/set_check.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/open_file.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

/// A file that the manifest lists; the size of a source is not known.
struct Listed {
  std::string file, sha256;
  std::optional<std::uint64_t> bytes;
  std::optional<std::uint32_t> index;
};

std::vector<Listed> listed_files(const Manifest& manifest) {
  std::vector<Listed> files;
  for (const ManifestEntry& entry : manifest.entries)
    files.push_back({entry.file, entry.sha256, entry.bytes, entry.index});
  for (const ManifestView& view : manifest.views)
    files.push_back({view.file, view.sha256, view.bytes, {}});
  if (manifest.head) {
    for (const SourceEntry& source : manifest.head->sources)
      files.push_back({source.file, source.sha256, {}, {}});
  }
  return files;
}

class Check {
 public:
  Check(const fs::path& directory, const Manifest& manifest,
        const CheckProgress& progress)
      : directory_(directory),
        set_(directory),
        manifest_(manifest),
        files_(listed_files(manifest)),
        progress_(progress) {
    for (const Listed& file : files_) {
      total_ += file.bytes.value_or(0);
      names_by_hash_.emplace(file.sha256, file.file);
      if (file.bytes) sizes_.insert(*file.bytes);
    }
  }

  std::vector<FileDefect> run() {
    check_manifest();
    for (const Listed& file : files_) check_file(file);
    check_directory();
    return std::move(defects_);
  }

 private:
  void add(const std::string& file, const std::string& what,
           std::optional<std::uint32_t> index = {}) {
    defects_.push_back({file, what, index});
  }

  void check_manifest() {
    for (const std::size_t line : manifest_.damaged_lines)
      add(kManifestName, fmt::format("line {} is damaged", line));
    if (!manifest_.is_finished) add(kManifestName, "is not finished");
    if (!manifest_.head) {
      add(kManifestName,
          "has no first line, which defines what belongs to the set");
      return;
    }
    check_head_copy(*manifest_.head);
    check_entries(*manifest_.head);
    if (!manifest_.is_finished) return;
    for (const std::string& run : manifest_.head->runs) {
      const std::string name = view_name(run);
      if (std::none_of(manifest_.views.begin(), manifest_.views.end(),
                       [&](const auto& view) { return view.file == name; }))
        add(name, "is not in the manifest");
    }
  }

  void check_head_copy(const ManifestHead& head) {
    const std::optional<FileFacts> facts = facts_of(kHeadCopyName, {});
    if (!facts) return;
    const Manifest copy = read_manifest(directory_, kHeadCopyName);
    if (copy.head != head || !copy.damaged_lines.empty())
      add(kHeadCopyName, "holds other bytes than were written");
  }

  void check_entries(const ManifestHead& head) {
    // The head may claim any number of files; only what is listed takes memory.
    constexpr std::size_t kMostListed = 100'000;
    const std::uint32_t planned = file_count(head);
    std::set<std::uint32_t> found;
    for (const ManifestEntry& entry : manifest_.entries) {
      if (entry.index >= planned) {
        add(entry.file,
            fmt::format("is number {} of {} files", entry.index, planned));
        continue;
      }
      found.insert(entry.index);
      const ManifestEntry expected = expected_entry(head, entry.index);
      if (entry.file != expected.file ||
          entry.first_device != expected.first_device ||
          entry.devices != expected.devices)
        add(expected.file, "has a wrong line in the manifest", entry.index);
    }
    std::size_t missing = planned - found.size();
    for (std::uint32_t index = 0, listed = 0;
         missing > 0 && listed < kMostListed; ++index) {
      if (found.contains(index)) continue;
      add(expected_entry(head, index).file, "is not in the manifest", index);
      --missing;
      ++listed;
    }
    if (missing > 0)
      add(kManifestName,
          fmt::format("lacks the lines of {} of {} files", missing, planned));
  }

  /// Nothing when it is no ordinary file, which is a defect.
  std::optional<FileFacts> facts_of(const std::string& name,
                                    std::optional<std::uint32_t> index) {
    try {
      const std::optional<FileFacts> facts = set_.find(name);
      if (facts && facts->is_regular) return facts;
      add(name,
          !facts           ? "is missing"
          : facts->is_link ? "is a symbolic link, which is not followed"
                           : "is no ordinary file",
          index);
    } catch (const std::system_error& error) {
      add(name,
          error.code() == std::errc::too_many_symbolic_link_levels
              ? "is behind a symbolic link, which is not followed"
              : "cannot be read: " + error.code().message(),
          index);
    }
    return {};
  }

  void check_file(const Listed& file) {
    const std::optional<FileFacts> facts = facts_of(file.file, file.index);
    if (!facts) return;
    const std::uint64_t size = facts->bytes;
    if (file.bytes && !sizes_.contains(size))
      return add_size(file, size);  // that of no file
    const std::string hash = hash_of(file);
    if (hash == file.sha256 || hash.empty()) return;
    const auto owner = names_by_hash_.find(hash);
    if (owner != names_by_hash_.end()) {
      add(file.file, fmt::format("holds the bytes of {}", owner->second),
          file.index);
    } else if (file.bytes && size != *file.bytes) {
      add_size(file, size);
    } else {
      add(file.file, "holds other bytes than were written", file.index);
    }
  }

  void add_size(const Listed& file, std::uint64_t size) {
    add(file.file, fmt::format("has {} bytes; expected {}", size, *file.bytes),
        file.index);
  }

  /// Empty when the file cannot be read, which is a defect of its own.
  std::string hash_of(const Listed& file) {
    try {
      OpenFile opened = set_.open(file.file, O_RDONLY | O_NONBLOCK);
      return sha256_of_rest(opened, [&](std::size_t size) {
        done_ += size;
        if (progress_) progress_(done_, std::max(done_, total_));
      });
    } catch (const std::system_error& error) {
      add(file.file, "cannot be read: " + error.code().message(), file.index);
      return {};
    }
  }

  void check_directory() {
    std::set<std::string> known;
    for (const Listed& file : files_) known.insert(file.file);
    known.insert(kHeadCopyName);
    if (manifest_.head) {
      for (const std::string& run : manifest_.head->runs)
        known.insert(view_name(run));
    }
    for (const std::string& name : names_below()) {
      const std::string kind = fs::path(name).extension().string();
      const bool is_ours =
          kind == ".h5" || kind == ".nc" || name.starts_with("source/");
      if (is_ours && !is_partial_file(name) && !known.contains(name) &&
          !(manifest_.head && is_file_of(*manifest_.head, name)))
        add(name, "does not belong to the set");
    }
  }

  std::vector<std::string> names_below() const {
    try {
      return set_.files_below();
    } catch (const std::system_error& error) {
      throw_file_error(directory_, "cannot read", error.code());
    }
  }

  const fs::path& directory_;
  const Directory set_;
  const Manifest& manifest_;
  std::vector<Listed> files_;
  const CheckProgress& progress_;
  std::map<std::string, std::string> names_by_hash_;
  std::set<std::uint64_t> sizes_;
  std::uint64_t done_ = 0, total_ = 0;
  std::vector<FileDefect> defects_;
};

}  // namespace

std::vector<FileDefect> check_set(const fs::path& directory,
                                  const Manifest& manifest,
                                  const CheckProgress& progress) {
  return Check(directory, manifest, progress).run();
}

}  // namespace beamgyro::internal
