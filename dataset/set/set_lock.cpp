// SPDX-License-Identifier: MIT
#include "dataset/set/set_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWhole = "set.lock";

/// Returns whether the error means that the file system has no such locks.
bool is_unknown(int error) {
  return error == ENOSYS || error == EOPNOTSUPP || error == ENOLCK ||
         error == EINVAL;
}

std::string reason(const std::error_code& error) {
  return error == std::errc::too_many_symbolic_link_levels
             ? "it is a symbolic link; expected an ordinary file, or none"
             : error.message();
}

std::error_code last_error() { return {errno, std::generic_category()}; }

/// Returns the holder that the file names, or an empty text.
std::string holder(const OpenFile& file) {
  std::array<char, 256> text{};
  const ssize_t size = uninterrupted(
      [&] { return pread(file.descriptor(), text.data(), text.size(), 0); });
  return {text.data(), static_cast<std::size_t>(size < 0 ? 0 : size)};
}

std::string on_this_host() {
  return fmt::format("host {}, process ", host_name());
}

/// Returns the number of the named process if it is of this host, or 0.
pid_t process_here(const std::string& who) {
  const std::string here = on_this_host();
  pid_t process = 0;
  if (who.starts_with(here))
    std::from_chars(who.data() + here.size(), who.data() + who.size(), process);
  return process;
}

}  // namespace

void SetLock::fail(const std::string& name, const std::string& why) const {
  throw std::runtime_error(
      fmt::format("{}: cannot lock: {}", (path_ / name).string(), why));
}

void SetLock::refuse(const std::string& who) const {
  throw std::runtime_error(fmt::format("{}: in use by {}", path_.string(),
                                       who.empty() ? "another process" : who));
}

// Opens the lock file. The holder is written into it, so it must not be
// somebody else's file.
OpenFile SetLock::open_lock(const std::string& name) const {
  try {
    OpenFile file = directory_.open(name, O_RDWR | O_CREAT | O_NONBLOCK);
    struct stat facts {};
    if (fstat(file.descriptor(), &facts) != 0) fail(name, reason(last_error()));
    if (!S_ISREG(facts.st_mode) || facts.st_nlink > 1)
      fail(name,
           "it is no ordinary file, or has another name, too; expected an "
           "ordinary file, or none");
    return file;
  } catch (const std::system_error& error) {
    fail(name, reason(error.code()));
  }
}

/// Whether the name still is that of the file: the holder before may have
/// removed it between opening and locking.
bool SetLock::is_current(const std::string& name, const OpenFile& file) const {
  struct stat there {
  }, ours{};
  return fstatat(directory_.descriptor(), name.c_str(), &there,
                 AT_SYMLINK_NOFOLLOW) == 0 &&
         fstat(file.descriptor(), &ours) == 0 && there.st_dev == ours.st_dev &&
         there.st_ino == ours.st_ino;
}

void SetLock::respect_the_living(const OpenFile& file) const {
  const std::string who = holder(file);
  const pid_t process = process_here(who);
  if (process > 0 && process != getpid() &&
      (kill(process, 0) == 0 || errno != ESRCH))
    refuse(who);
}

SetLock::Held SetLock::acquire(const std::string& name, int operation) {
  // The last of those who share a lock has it alone while it removes it.
  constexpr int kMostTries = 50;
  constexpr std::chrono::milliseconds kPause{20};
  for (int tries = 1;;) {
    OpenFile file = open_lock(name);
    bool by_kernel = true;
    if (uninterrupted([&] {
          return flock(file.descriptor(), operation | LOCK_NB);
        }) != 0) {
      by_kernel = !is_unknown(errno);
      if (by_kernel && errno != EWOULDBLOCK) fail(name, reason(last_error()));
      if (by_kernel && operation == LOCK_SH && tries++ < kMostTries) {
        std::this_thread::sleep_for(kPause);
        continue;
      }
      if (by_kernel) refuse(holder(file));
      if (operation == LOCK_EX) respect_the_living(file);
    }
    if (!is_current(name, file)) continue;
    if (operation == LOCK_EX) dead_holder_ = holder(file);
    const std::string who = fmt::format("{}{}", on_this_host(), getpid());
    if (ftruncate(file.descriptor(), 0) != 0 ||
        pwrite(file.descriptor(), who.data(), who.size(), 0) < 0) {
      // The name of the holder is for messages only, so a full disk is no
      // failure.
    }
    return {name, std::move(file), by_kernel};
  }
}

void SetLock::release(Held& held) const noexcept {
  // Of several who share it the last one removes the file.
  const bool is_last =
      held.by_kernel ? flock(held.file.descriptor(), LOCK_EX | LOCK_NB) == 0
                     : process_here(holder(held.file)) == getpid();
  if (is_last && is_current(held.name, held.file))
    unlinkat(directory_.descriptor(), held.name.c_str(), 0);
}

Directory SetLock::opened(const fs::path& directory) {
  try {
    return Directory(directory);
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: cannot lock: {}",
                                         (directory / kWhole).string(),
                                         error.code().message()));
  }
}

SetLock::SetLock(const fs::path& directory, const std::string& task)
    : path_(directory), directory_(opened(directory)) {
  if (task.empty()) {
    whole_.emplace(acquire(kWhole, LOCK_EX));
    return;
  }
  whole_.emplace(acquire(kWhole, LOCK_SH));
  try {
    task_.emplace(acquire(task + ".lock", LOCK_EX));
  } catch (...) {
    release(*whole_);
    throw;
  }
}

SetLock::~SetLock() {
  if (task_) release(*task_);
  if (whole_) release(*whole_);
}

}  // namespace beamgyro::internal
