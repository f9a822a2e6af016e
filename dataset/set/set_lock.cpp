// SPDX-License-Identifier: MIT
#include "dataset/set/set_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "dataset/atomic_file.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWhole = "set.lock";

[[noreturn]] void fail(const fs::path& path, int error) {
  throw std::runtime_error(fmt::format("{}: cannot lock: {}", path.string(),
                                       std::generic_category().message(error)));
}

OpenFile open_lock(const fs::path& path) {
  try {
    return {path, O_RDWR | O_CREAT};
  } catch (const std::system_error& error) {
    fail(path, error.code().value());
  }
}

/// Whether `path` still names the file: the holder before may have removed it
/// between opening and locking.
bool is_current(const fs::path& path, const OpenFile& file) {
  struct stat there {
  }, ours{};
  return stat(path.c_str(), &there) == 0 &&
         fstat(file.descriptor(), &ours) == 0 && there.st_dev == ours.st_dev &&
         there.st_ino == ours.st_ino;
}

/// Who is named in the file, empty if nobody.
std::string holder(OpenFile& file) {
  std::array<char, 256> text{};
  const ssize_t size = pread(file.descriptor(), text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(size < 0 ? 0 : size)};
}

}  // namespace

SetLock::Held SetLock::acquire(const fs::path& path, int operation) {
  // The last of those who share a lock has it alone while it removes it.
  constexpr int kMostTries = 50;
  constexpr std::chrono::milliseconds kPause{20};
  for (int tries = 1;;) {
    OpenFile file = open_lock(path);
    if (flock(file.descriptor(), operation | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno != EWOULDBLOCK) fail(path, errno);
      if (operation == LOCK_SH && tries++ < kMostTries) {
        std::this_thread::sleep_for(kPause);
        continue;
      }
      const std::string who = holder(file);
      throw std::runtime_error(
          fmt::format("{}: in use by {}", path.parent_path().string(),
                      who.empty() ? "another process" : who));
    }
    if (!is_current(path, file)) continue;
    if (operation == LOCK_EX) stale_ = holder(file);
    const std::string who =
        fmt::format("host {}, process {}", host_name(), getpid());
    if (ftruncate(file.descriptor(), 0) != 0 ||
        pwrite(file.descriptor(), who.data(), who.size(), 0) < 0) {
      // Who holds it is for messages only; the disk may be full.
    }
    return {path, std::move(file)};
  }
}

void SetLock::release(Held& held) noexcept {
  // Of several who share it the last one removes the file.
  if (flock(held.file.descriptor(), LOCK_EX | LOCK_NB) == 0 &&
      is_current(held.path, held.file))
    unlink(held.path.c_str());
}

SetLock::SetLock(const fs::path& directory, const std::string& task) {
  if (task.empty()) {
    whole_.emplace(acquire(directory / kWhole, LOCK_EX));
    return;
  }
  whole_.emplace(acquire(directory / kWhole, LOCK_SH));
  try {
    task_.emplace(acquire(directory / (task + ".lock"), LOCK_EX));
  } catch (...) {
    release(*whole_);
    throw;
  }
}

SetLock::~SetLock() {
  if (task_) release(*task_);
  if (whole_) release(*whole_);
}

}  // namespace beamgyro
