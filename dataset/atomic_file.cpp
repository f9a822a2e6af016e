// SPDX-License-Identifier: MIT
#include "dataset/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

enum SlotState : int { kFree, kFilling, kTaken };

/// Names of the partial files in storage that never moves and is never freed,
/// so that a signal handler may read it at any moment.
struct Slot {
  std::atomic<int> state{kFree};
  std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, 64> partial_files;

std::size_t take_slot() {
  for (std::size_t i = 0; i < partial_files.size(); ++i) {
    int expected = kFree;
    if (partial_files[i].state.compare_exchange_strong(expected, kFilling))
      return i;
  }
  throw std::runtime_error("too many unfinished files at once");
}

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void reject(const fs::path& path, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("{}: cannot write: {}", path.string(), why));
}

[[noreturn]] void fail(const fs::path& path, int error) {
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}", path.string(), reason(error)));
}

bool is_wrong_place(int error) {
  return error == EACCES || error == EPERM || error == EROFS ||
         error == ENOENT || error == ENOTDIR || error == EISDIR ||
         error == ELOOP || error == ENAMETOOLONG;
}

/// The file to replace: `path`, or what it links to.
fs::path checked_target(const fs::path& path) {
  if (path.empty()) throw std::invalid_argument("an output file has no name");
  std::error_code ignored;
  const fs::path target = fs::is_symlink(fs::symlink_status(path, ignored))
                              ? fs::weakly_canonical(path, ignored)
                              : path;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status) || !target.has_filename())
    reject(path, "it is a directory; expected a file name");
  if (fs::exists(status) && !fs::is_regular_file(status))
    reject(path, "it is a device, pipe or socket; expected a file name");
  if (fs::exists(status) &&
      faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    reject(path, "the file that is there is write-protected");
  return target;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(checked_target(path)) {
  slot_ = take_slot();
  Slot& slot = partial_files[slot_];
  int file = -1;
  for (int attempt = 0; file < 0; ++attempt) {
    const std::string partial =
        fmt::format("{}.partial-{}-{}", path_.string(), getpid(), attempt);
    // Too long for the slot is too long for open() too.
    if (partial.size() < slot.path.size()) {
      partial.copy(slot.path.data(), partial.size());
      slot.path[partial.size()] = '\0';
    }
    // Exclusive: a partial file that is there belongs to somebody else.
    file = open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) {
      const int error = errno;
      slot.state = kFree;
      if (!is_wrong_place(error)) fail(path, error);
      const fs::path directory = path_.parent_path();
      reject(path, fmt::format("directory {}: {}; expected one that is there "
                               "and writable",
                               directory.empty() ? "." : directory.string(),
                               reason(error)));
    }
    partial_path_ = partial;
  }
  slot.state = kTaken;
  close(file);
}

AtomicFile::~AtomicFile() {
  if (!published_) unlink(partial_path_.c_str());
  partial_files[slot_].state = kFree;
}

void AtomicFile::publish() {
  if (std::rename(partial_path_.c_str(), path_.c_str()) != 0)
    fail(path_, errno);
  published_ = true;
}

void require_writable(const fs::path& path) { const AtomicFile probe(path); }

void write_text_file(const fs::path& path, std::string_view text) {
  AtomicFile target(path);
  const int file = open(target.partial_path().c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  int error = 0;
  while (!text.empty() && error == 0) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (close(file) != 0 && error == 0) error = errno;
  if (error != 0) fail(path, error);
  target.publish();
}

void remove_partial_files() noexcept {
  for (const Slot& slot : partial_files) {
    if (slot.state == kTaken) unlink(slot.path.data());
  }
}

}  // namespace beamgyro
