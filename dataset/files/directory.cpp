// SPDX-License-Identifier: MIT
#include "dataset/files/directory.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/file_error.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_PATH | O_DIRECTORY;
constexpr mode_t kMode = 0666;

[[noreturn]] void fail_directory(int error) {
  throw std::system_error(error, std::generic_category());
}

void require_below(const fs::path& name) {
  const bool leads_out =
      name.empty() || name.is_absolute() ||
      std::any_of(name.begin(), name.end(), [](const fs::path& part) {
        return part.empty() || part == "." || part == "..";
      });
  if (leads_out)
    throw std::invalid_argument(
        fmt::format("\"{}\": expected the name of a file below its directory",
                    name.string()));
}

struct stat stat_of(int descriptor) {
  struct stat facts {};
  if (fstat(descriptor, &facts) != 0) fail_directory(errno);
  return facts;
}

/// Opens the parts of the name one by one, so that no link is followed.
int open_by_parts(int directory, const fs::path& name, int flags) {
  std::vector<OpenFile> parents;
  for (const fs::path& part : name.parent_path()) {
    const int at = parents.empty() ? directory : parents.back().descriptor();
    parents.emplace_back(uninterrupted([&] {
      return openat(at, part.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC);
    }));
    const mode_t kind = stat_of(parents.back().descriptor()).st_mode;
    if (S_ISLNK(kind)) fail_directory(ELOOP);
    if (!S_ISDIR(kind)) fail_directory(ENOTDIR);
  }
  const int at = parents.empty() ? directory : parents.back().descriptor();
  const fs::path last = name.filename();
  return uninterrupted([&] { return openat(at, last.c_str(), flags, kMode); });
}

int open_beneath(int directory, const fs::path& name, int flags) {
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags);
  how.mode = (flags & O_CREAT) != 0 ? kMode : 0;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS;
  for (;;) {
    const long file =
        syscall(SYS_openat2, directory, name.c_str(), &how, sizeof how);
    if (file >= 0) return static_cast<int>(file);
    if (errno == EINTR || errno == EAGAIN) continue;
    // The kernel lacks the call, or a filter refuses it.
    if (errno == ENOSYS || errno == EPERM || errno == EINVAL)
      return open_by_parts(directory, name, flags);
    return -1;
  }
}

}  // namespace

Directory::Directory(const fs::path& path)
    : file_(path.empty() ? fs::path(".") : path, kFolder) {}

OpenFile Directory::open(const fs::path& name, int flags) const {
  require_below(name);
  return OpenFile(
      open_beneath(descriptor(), name, flags | O_NOFOLLOW | O_CLOEXEC));
}

std::optional<FileFacts> Directory::find(const fs::path& name) const {
  try {
    const OpenFile file = open(name, O_PATH);
    const struct stat facts = stat_of(file.descriptor());
    return FileFacts{S_ISREG(facts.st_mode), S_ISDIR(facts.st_mode),
                     S_ISLNK(facts.st_mode),
                     static_cast<std::uint64_t>(facts.st_size), facts.st_nlink};
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory ||
        error.code() == std::errc::not_a_directory)
      return {};
    throw;
  }
}

Directory Directory::subdirectory(const fs::path& name) const {
  if (name.empty())
    return Directory(OpenFile(fcntl(descriptor(), F_DUPFD_CLOEXEC, 0)));
  return Directory(open(name, kFolder));
}

Directory Directory::make_subdirectory(const fs::path& name) const {
  Directory last = subdirectory({});
  std::vector<Directory> made;
  for (const fs::path& part : name) {
    require_below(part);
    const Directory& parent = made.empty() ? last : made.back();
    const int answer = uninterrupted(
        [&] { return mkdirat(parent.descriptor(), part.c_str(), 0777); });
    if (answer != 0 && errno != EEXIST) fail_directory(errno);
    made.push_back(parent.subdirectory(part));
  }
  return made.empty() ? std::move(last) : std::move(made.back());
}

std::vector<std::string> Directory::names() const {
  OpenFile file(uninterrupted([&] {
    return openat(descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  }));
  const std::unique_ptr<DIR, int (*)(DIR*)> list(fdopendir(file.descriptor()),
                                                 closedir);
  if (list == nullptr) fail_directory(errno);
  file.release();
  std::vector<std::string> names;
  for (errno = 0; const dirent* entry = readdir(list.get()); errno = 0) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
  }
  if (errno != 0) fail_directory(errno);
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> Directory::files_below() const {
  std::vector<std::string> files;
  for (const std::string& name : names()) {
    const std::optional<FileFacts> facts = find(name);
    if (!facts) continue;  // somebody has removed it meanwhile
    if (!facts->is_directory) {
      files.push_back(name);
      continue;
    }
    for (const std::string& file : subdirectory(name).files_below())
      files.push_back(fmt::format("{}/{}", name, file));
  }
  return files;
}

void Directory::remove(const std::string& name) const {
  const int answer =
      uninterrupted([&] { return unlinkat(descriptor(), name.c_str(), 0); });
  if (answer != 0 && errno != ENOENT) fail_directory(errno);
}

void Directory::sync() const {
  try {
    OpenFile(uninterrupted([&] {
      return openat(descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    })).sync();
  } catch (const std::system_error& error) {
    // Some network file systems cannot, and need not; a directory may be one
    // that nobody may list.
    if (error.code() != std::errc::invalid_argument &&
        error.code() != std::errc::permission_denied)
      throw;
  }
}

MadeDirectories::MadeDirectories(const std::filesystem::path& path) {
  try {
    std::filesystem::path place;
    for (const std::filesystem::path& part : path) {
      place /= part;
      if (uninterrupted([&] { return mkdir(place.c_str(), 0777); }) == 0)
        made_.push_back(place);
      else if (errno != EEXIST)
        throw_file_error(path, "cannot make this directory",
                         {errno, std::generic_category()},
                         "one that is there or can be made");
    }
    if (!std::filesystem::is_directory(status_of(path)))
      throw std::invalid_argument(fmt::format(
          "{}: is no directory; expected one that is there or can be made",
          path.string()));
  } catch (...) {
    remove_empty();
    throw;
  }
}

void MadeDirectories::remove_empty() noexcept {
  for (; !made_.empty(); made_.pop_back()) rmdir(made_.back().c_str());
}

FileState state_of_file(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {found.st_dev,
          found.st_ino,
          found.st_size,
          {found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_ctim.tv_sec,
           found.st_ctim.tv_nsec}};
}

}  // namespace beamgyro::internal
