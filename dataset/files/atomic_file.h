// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "dataset/files/directory.h"
#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// A file that appears under its name only when it is complete. It is written
/// to a partial file in the same directory, whose name contains host and
/// process; publish() renames it. Until then the file of that name, if there is
/// one, is unchanged. The partial file stays open all the time, so that another
/// user of the directory cannot replace it unnoticed.
class AtomicFile {
 public:
  /// Creates the empty partial file, and removes partial files for `path` of
  /// processes that died on this host. A symbolic link is followed and its
  /// target replaced, unless it is another user's link in a directory that all
  /// may write to.
  /// - Throws std::invalid_argument for a name that is empty, a directory, a
  ///   device or write-protected, and for a directory that is missing or not
  ///   writable.
  /// - Throws FileError when creating fails for another reason.
  explicit AtomicFile(const std::filesystem::path& path);

  /// The same for `name` in `directory`, called `path` in messages. A symbolic
  /// link of that name is replaced and not followed, and partial files of dead
  /// processes stay.
  AtomicFile(const Directory& directory, const std::string& name,
             const std::filesystem::path& path);
  ~AtomicFile();  // removes the partial file unless published
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the partial file, open for reading and writing. publish() closes
  /// it.
  OpenFile& file() { return *file_; }

  /// Returns the path of the partial file.
  std::filesystem::path partial_path() const;

  /// Synchronises the file with the disk, gives it the mode of the file that it
  /// replaces, renames it, and synchronises the directory. Throws FileError
  /// when that fails, and std::runtime_error when another file has taken the
  /// place of the partial one.
  void publish();

 private:
  void create();
  std::optional<mode_t> replaced_mode() const;
  void require_own_partial_file() const;

  std::filesystem::path path_;  // for messages, and to find the place again
  Directory directory_;
  std::string name_, partial_name_;
  std::optional<OpenFile> file_;
  std::size_t slot_ = 0;  // in the table of partial files
  bool published_ = false;
};

/// Throws what writing to `path` would throw at its start. Leaves no file.
void require_writable(const std::filesystem::path& path);

/// Writes `text` to a file that is not published yet, called `path` in
/// messages. Throws FileError.
void write_partial_file(AtomicFile& file, const std::filesystem::path& path,
                        std::string_view text);

/// Writes `text` to `path`, completely or not at all. Throws as AtomicFile, and
/// FileError when writing fails.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Removes the partial files of all AtomicFiles that live in this process. May
/// be called from a signal handler that ends the process.
void remove_partial_files() noexcept;

/// Returns whether this is the name of a partial file.
bool is_partial_file(const std::string& name);

/// Removes partial files that dead writers left in `directory`: those of this
/// host whose process is gone and, with `of_any_host`, those of any writer but
/// this process (for a directory that nobody else can be writing to). If `only`
/// is not empty, it removes partial files for that name only.
void remove_dead_partial_files(const Directory& directory, bool of_any_host,
                               std::string_view only = {});

/// Returns the name of this machine as used in the names of partial files.
std::string host_name();

}  // namespace beamgyro::internal
