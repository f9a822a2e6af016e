// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace beamgyro {

/// A file that appears under its name only when it is complete. What is written
/// goes to partial_path() in the same directory, a name with host and process;
/// publish() renames it. Until then the name asked for holds what it held
/// before.
class AtomicFile {
 public:
  /// Creates the empty partial file. A symbolic link is followed, and what it
  /// names is replaced. Throws std::invalid_argument for a name that is empty,
  /// a directory, a device or write-protected, and for a directory that is
  /// missing or not writable; std::runtime_error when creating fails otherwise.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();  // removes the partial file unless published
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& partial_path() const { return partial_path_; }

  /// Throws std::runtime_error when the partial file cannot be renamed.
  void publish();

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_path_;
  std::size_t slot_ = 0;  // in the table of partial files
  bool published_ = false;
};

/// Throws what writing to `path` would throw at its start; leaves nothing.
void require_writable(const std::filesystem::path& path);

/// Writes `text` under `path`, complete or not at all. Throws as AtomicFile,
/// and std::runtime_error when writing fails.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Removes the partial files of all AtomicFiles that live in this process. May
/// be called from a signal handler that ends the process.
void remove_partial_files() noexcept;

/// Whether a file of this name is one that some AtomicFile has not published.
bool is_partial_file(const std::string& name);

/// Removes the partial files that writers left in `directory` when they died:
/// those of this host whose process is gone, and of any writer but this process
/// if nobody else can be writing there.
void remove_dead_partial_files(const std::filesystem::path& directory,
                               bool of_any_host);

/// Of this machine, as partial files are named after it.
std::string host_name();

}  // namespace beamgyro
