// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "dataset/directory.h"
#include "dataset/open_file.h"

namespace beamgyro {

/// A file that appears under its name only when it is complete. What is written
/// goes to a partial file in the same directory, whose name tells host and
/// process; publish() renames it. Until then the name asked for holds what it
/// held before. The partial file stays open all the time, so that nobody who
/// may write to the directory can put another one in its place.
class AtomicFile {
 public:
  /// Creates the empty partial file. A symbolic link is followed, and what it
  /// names is replaced, unless it is another user's in a directory for all.
  /// Removes partial files for `path` of processes that died on this host.
  /// Throws std::invalid_argument for a name that is empty, a directory, a
  /// device or write-protected, and for a directory that is missing or not
  /// writable; FileError when creating fails otherwise.
  explicit AtomicFile(const std::filesystem::path& path);

  /// Of `name` in `directory`, called `path` in messages. A symbolic link under
  /// that name is replaced, not followed, and partial files stay.
  AtomicFile(const Directory& directory, const std::string& name,
             const std::filesystem::path& path);
  ~AtomicFile();  // removes the partial file unless published
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The partial file, open for reading and writing; closed by publish().
  OpenFile& file() { return *file_; }

  /// Where the partial file is.
  std::filesystem::path partial_path() const;

  /// Puts everything on the disk, gives the file the mode of the one it
  /// replaces, renames it and puts the name on the disk, too. Throws FileError
  /// when that fails, and std::runtime_error when somebody has put another file
  /// in the place of the partial one.
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

/// Throws what writing to `path` would throw at its start; leaves nothing.
void require_writable(const std::filesystem::path& path);

/// Writes `text` under `path`, complete or not at all. Throws as AtomicFile,
/// and FileError when writing fails.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Removes the partial files of all AtomicFiles that live in this process. May
/// be called from a signal handler that ends the process.
void remove_partial_files() noexcept;

/// Whether a file of this name is one that some AtomicFile has not published.
bool is_partial_file(const std::string& name);

/// Removes the partial files that writers left in `directory` when they died:
/// those of this host whose process is gone, and of any writer but this process
/// if nobody else can be writing there. Of files called `only`, unless that is
/// empty.
void remove_dead_partial_files(const Directory& directory, bool of_any_host,
                               std::string_view only = {});

/// Of this machine, as partial files are named after it.
std::string host_name();

}  // namespace beamgyro
