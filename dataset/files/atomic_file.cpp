// SPDX-License-Identifier: MIT
#include "dataset/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
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

#include "config/file_error.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

enum SlotState : int { kFree, kFilling, kTaken };

/// Directories and names of the partial files in storage that never moves and
/// is never freed, so that a signal handler may read it at any moment.
struct Slot {
  std::atomic<int> state{kFree};
  int directory = -1;
  std::array<char, NAME_MAX + 1> name{};
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, 64> partial_files;

// Takes a free slot. With more threads than slots it waits.
std::size_t take_slot() {
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    for (std::size_t i = 0; i < partial_files.size(); ++i) {
      int expected = kFree;
      if (partial_files[i].state.compare_exchange_strong(expected, kFilling))
        return i;
    }
  }
}

std::error_code last_error() { return {errno, std::generic_category()}; }

[[noreturn]] void reject(const fs::path& path, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("{}: cannot write: {}", path.string(), why));
}

[[noreturn]] void fail_writing(const fs::path& path,
                               const std::error_code& error) {
  throw FileError(
      fmt::format("{}: cannot write: {}", path.string(), error.message()),
      error);
}

constexpr std::string_view kPartial = ".partial-";

/// Refuses a link of another user in a directory that all may write to, as the
/// kernel's protected_symlinks does, because it may lead anywhere.
void require_followable(const fs::path& link) {
  struct stat of_link {
  }, of_directory{};
  const fs::path parent = link.parent_path();
  if (lstat(link.c_str(), &of_link) != 0 ||
      stat(parent.empty() ? "." : parent.c_str(), &of_directory) != 0)
    return;  // what is wrong with it shows when it is written
  const bool for_all = (of_directory.st_mode & S_ISVTX) != 0 &&
                       (of_directory.st_mode & S_IWOTH) != 0;
  if (for_all && of_link.st_uid != geteuid() &&
      of_link.st_uid != of_directory.st_uid)
    reject(link,
           "it is a symbolic link of another user in a directory for all; "
           "expected another name");
}

/// The file to replace: `path`, or what it links to.
fs::path checked_target(const fs::path& path) {
  if (path.empty()) throw std::invalid_argument("an output file has no name");
  if (path.native().find('\0') != fs::path::string_type::npos)
    throw std::invalid_argument(fmt::format(
        "{}: the name of an output file holds a NUL", path.c_str()));
  std::error_code ignored;
  const bool is_link = fs::is_symlink(fs::symlink_status(path, ignored));
  if (is_link) require_followable(path);
  const fs::path target = is_link ? fs::weakly_canonical(path, ignored) : path;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status) || !target.has_filename())
    reject(path, "it is a directory; expected a file name");
  if (fs::exists(status) && !fs::is_regular_file(status))
    reject(path, "it is a device, pipe or socket; expected a file name");
  if (fs::exists(status) && uninterrupted([&] {
                              return faccessat(AT_FDCWD, target.c_str(), W_OK,
                                               AT_EACCESS);
                            }) != 0) {
    if (!is_wrong_name(last_error())) fail_writing(path, last_error());
    reject(path, "the file that is there is write-protected");
  }
  return target;
}

/// A wrong directory is wrong input, any other failure is failed work.
[[noreturn]] void fail_in(const fs::path& path, const std::error_code& error) {
  if (!is_wrong_name(error)) fail_writing(path, error);
  const fs::path directory = path.parent_path();
  reject(path, fmt::format("directory {}: {}; expected one that is there and "
                           "writable",
                           directory.empty() ? "." : directory.string(),
                           error.message()));
}

Directory directory_of(const fs::path& path) {
  try {
    return Directory(path.parent_path());
  } catch (const std::system_error& error) {
    fail_in(path, error.code());
  }
}

struct Writer {
  std::string host;
  pid_t process = 0;
};

/// Returns the writer of the partial file of this name, if it is one.
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
bool is_ours(const std::string& name) {
  return std::any_of(partial_files.begin(), partial_files.end(),
                     [&](const Slot& slot) {
                       return slot.state == kTaken && slot.name.data() == name;
                     });
}

bool is_dead(const Writer& writer) {
  return writer.host == host_name() &&
         (writer.process == getpid() ||
          (kill(writer.process, 0) != 0 && errno == ESRCH));
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path)
    : path_(checked_target(path)),
      directory_(directory_of(path_)),
      name_(path_.filename().string()) {
  try {
    remove_dead_partial_files(directory_, false, name_);
  } catch (const std::system_error&) {
    // The directory may be one that nobody may list.
  }
  create();
}

AtomicFile::AtomicFile(const Directory& directory, const std::string& name,
                       const fs::path& path)
    : path_(path), directory_(directory.subdirectory({})), name_(name) {
  const std::optional<FileFacts> there = directory.find(name);
  if (there && !there->is_regular && !there->is_link)
    reject(path, "it is no ordinary file; expected one, or none");
  create();
}

void AtomicFile::create() {
  slot_ = take_slot();
  Slot& slot = partial_files[slot_];
  slot.directory = directory_.descriptor();
  int file = -1;
  for (int attempt = 0; file < 0; ++attempt) {
    partial_name_ = fmt::format("{}{}{}-{}-{}", name_, kPartial, host_name(),
                                getpid(), attempt);
    // Too long for the slot is too long for openat() too.
    if (partial_name_.size() < slot.name.size()) {
      partial_name_.copy(slot.name.data(), partial_name_.size());
      slot.name[partial_name_.size()] = '\0';
    }
    // Exclusive: a partial file that is there belongs to somebody else.
    file = uninterrupted([&] {
      return openat(slot.directory, partial_name_.c_str(),
                    O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    });
    if (file < 0 && errno != EEXIST) {
      const std::error_code error = last_error();
      slot.state = kFree;
      fail_in(path_, error);
    }
  }
  slot.state = kTaken;
  file_.emplace(file);
  // The new file must not be readable to more users than the one that it
  // replaces.
  if (const auto mode = replaced_mode())
    fchmod(file, (*mode & 0666) | S_IRUSR | S_IWUSR);
}

AtomicFile::~AtomicFile() {
  if (!published_) unlinkat(directory_.descriptor(), partial_name_.c_str(), 0);
  partial_files[slot_].state = kFree;
}

fs::path AtomicFile::partial_path() const {
  return path_.parent_path() / partial_name_;
}

/// Returns the mode of the file that will be replaced, if there is one.
std::optional<mode_t> AtomicFile::replaced_mode() const {
  struct stat there {};
  if (fstatat(directory_.descriptor(), name_.c_str(), &there,
              AT_SYMLINK_NOFOLLOW) != 0 ||
      !S_ISREG(there.st_mode))
    return {};
  return there.st_mode & 0777;
}

void AtomicFile::require_own_partial_file() const {
  struct stat ours {
  }, there{};
  if (fstat(file_->descriptor(), &ours) != 0 ||
      fstatat(directory_.descriptor(), partial_name_.c_str(), &there,
              AT_SYMLINK_NOFOLLOW) != 0)
    fail_writing(path_, last_error());
  if (ours.st_dev != there.st_dev || ours.st_ino != there.st_ino)
    throw std::runtime_error(fmt::format(
        "{}: cannot write: another process has replaced the unfinished {}",
        path_.string(), partial_name_));
}

void AtomicFile::publish() try {
  file_->sync();
  if (const auto mode = replaced_mode()) {
    if (fchmod(file_->descriptor(), *mode) != 0)
      fail_writing(path_, last_error());
  }
  require_own_partial_file();
  file_->close();
  const int directory = directory_.descriptor();
  if (uninterrupted([&] {
        return renameat(directory, partial_name_.c_str(), directory,
                        name_.c_str());
      }) != 0)
    fail_writing(path_, last_error());
  published_ = true;
  directory_.sync();
} catch (const std::system_error& error) {
  fail_writing(path_, error.code());
}

void require_writable(const fs::path& path) { const AtomicFile probe(path); }

void write_partial_file(AtomicFile& file, const fs::path& path,
                        std::string_view text) {
  try {
    file.file().write(std::as_bytes(std::span(text)));
  } catch (const std::system_error& error) {
    fail_writing(path, error.code());
  }
}

void write_text_file(const fs::path& path, std::string_view text) {
  AtomicFile target(path);
  write_partial_file(target, path, text);
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

void remove_dead_partial_files(const Directory& directory, bool of_any_host,
                               std::string_view only) {
  for (const std::string& name : directory.names()) {
    const std::optional<Writer> writer = writer_of(name);
    if (!writer || is_ours(name)) continue;
    if (!only.empty() && name.substr(0, name.rfind(kPartial)) != only) continue;
    if (of_any_host || is_dead(*writer)) directory.remove(name);
  }
}

void remove_partial_files() noexcept {
  for (const Slot& slot : partial_files) {
    if (slot.state == kTaken) unlinkat(slot.directory, slot.name.data(), 0);
  }
}

}  // namespace beamgyro::internal
