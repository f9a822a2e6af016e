// SPDX-License-Identifier: MIT
#include "dataset/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <climits>
#include <csignal>
#include <cstdio>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "dataset/open_file.h"

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

// With more threads than slots the last ones wait.
std::size_t take_slot() {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    for (std::size_t i = 0; i < partial_files.size(); ++i) {
      int expected = kFree;
      if (partial_files[i].state.compare_exchange_strong(expected, kFilling))
        return i;
    }
  }
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

constexpr std::string_view kPartial = ".partial-";

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

struct Writer {
  std::string host;
  pid_t process = 0;
};

/// Who writes the partial file of this name, if it is one.
std::optional<Writer> writer_of(const std::string& name) {
  const std::size_t mark = name.rfind(kPartial);
  if (mark == std::string::npos) return {};
  const std::string text = name.substr(mark + kPartial.size());
  const std::size_t attempt = text.rfind('-');
  if (attempt == std::string::npos || attempt == 0) return {};
  const std::size_t process = text.rfind('-', attempt - 1);
  if (process == std::string::npos) return {};
  Writer writer{text.substr(0, process), 0};
  const char* const end = text.data() + attempt;
  const auto read =
      std::from_chars(text.data() + process + 1, end, writer.process);
  if (read.ec != std::errc() || read.ptr != end || writer.process <= 0)
    return {};
  return writer;
}

/// Whether an AtomicFile of this process writes it.
bool is_ours(const fs::path& partial) {
  return std::any_of(
      partial_files.begin(), partial_files.end(), [&](const Slot& slot) {
        return slot.state == kTaken &&
               fs::path(slot.path.data()).filename() == partial.filename();
      });
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(checked_target(path)) {
  slot_ = take_slot();
  Slot& slot = partial_files[slot_];
  int file = -1;
  for (int attempt = 0; file < 0; ++attempt) {
    const std::string partial =
        fmt::format("{}{}{}-{}-{}", path_.string(), kPartial, host_name(),
                    getpid(), attempt);
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
  try {
    OpenFile file(target.partial_path(), O_WRONLY);
    file.write(std::as_bytes(std::span(text)));
    file.close();
  } catch (const std::system_error& error) {
    fail(path, error.code().value());
  }
  target.publish();
}

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "localhost";
  std::string text = name.data();
  std::replace(text.begin(), text.end(), '/', '_');
  return text;
}

bool is_partial_file(const std::string& name) {
  return writer_of(name).has_value();
}

void remove_dead_partial_files(const fs::path& directory, bool of_any_host) {
  std::error_code ignored;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(directory, ignored)) {
    const std::optional<Writer> writer =
        writer_of(entry.path().filename().string());
    if (!writer || is_ours(entry.path())) continue;
    const bool is_dead = writer->host == host_name() &&
                         (writer->process == getpid() ||
                          (kill(writer->process, 0) != 0 && errno == ESRCH));
    if (is_dead || of_any_host) unlink(entry.path().c_str());
  }
}

void remove_partial_files() noexcept {
  for (const Slot& slot : partial_files) {
    if (slot.state == kTaken) unlink(slot.path.data());
  }
}

}  // namespace beamgyro
