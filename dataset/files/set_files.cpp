// SPDX-License-Identifier: MIT
#include "dataset/files/set_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_on(const fs::path& path, const std::error_code& error) {
  if (error == std::errc::too_many_symbolic_link_levels)
    throw std::invalid_argument(fmt::format(
        "{}: is a symbolic link or behind one, and none is followed in a set; "
        "expected an ordinary file",
        path.string()));
  throw_file_error(path, "cannot open", error);
}

void remove_below(const Directory& directory, bool of_any_host) {
  remove_dead_partial_files(directory, of_any_host);
  for (const std::string& name : directory.names()) {
    const std::optional<FileFacts> facts = directory.find(name);
    if (facts && facts->is_directory)
      remove_below(directory.subdirectory(name), of_any_host);
  }
}

std::string room_in(const fs::path& file) {
  struct statvfs space {};
  const fs::path directory = file.parent_path();
  if (statvfs(directory.empty() ? "." : directory.c_str(), &space) != 0)
    return {};
  return fmt::format(", {} are free there",
                     std::uint64_t{space.f_bavail} * space.f_frsize);
}

[[noreturn]] void fail_publishing(const fs::path& path, std::size_t size,
                                  const std::error_code& error) {
  const bool is_full =
      error == std::errc::no_space_on_device ||
      error == std::error_code(EDQUOT, std::generic_category());
  throw FileError(
      fmt::format("{}: cannot write: {}; {} bytes are needed{}", path.string(),
                  error.message(), size, is_full ? room_in(path) : ""),
      error);
}

void require_same(const fs::path& path, OpenFile& file,
                  std::span<const std::byte> bytes) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::vector<std::byte> piece(std::min(kPiece, bytes.size()));
  for (std::size_t place = 0; place < bytes.size();) {
    const std::size_t size = std::min(piece.size(), bytes.size() - place);
    if (file.read({piece.data(), size}) != size ||
        std::memcmp(piece.data(), bytes.data() + place, size) != 0) {
      throw std::runtime_error(fmt::format(
          "{}: reads back other bytes than were written", path.string()));
    }
    place += size;
  }
}

Directory made_directory(const fs::path& directory, const fs::path& name) {
  try {
    return Directory(directory).make_subdirectory(name.parent_path());
  } catch (const std::system_error& error) {
    throw_file_error((directory / name).parent_path(), "cannot write",
                     error.code(),
                     "a directory that is there and writable, no link");
  }
}

}  // namespace

OpenFile open_set_file(const fs::path& directory, const fs::path& name,
                       int flags) {
  const fs::path path = directory / name;
  try {
    // Without this flag opening a pipe would wait for its other end.
    OpenFile file = Directory(directory).open(name, flags | O_NONBLOCK);
    struct stat facts {};
    if (fstat(file.descriptor(), &facts) != 0)
      fail_on(path, {errno, std::generic_category()});
    if (!S_ISREG(facts.st_mode))
      throw std::invalid_argument(
          fmt::format("{}: is no ordinary file; expected one", path.string()));
    return file;
  } catch (const std::system_error& error) {
    fail_on(path, error.code());
  }
}

std::string read_set_file(const fs::path& directory, const fs::path& name) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 30;  // [bytes]
  std::string text;
  OpenFile file = open_set_file(directory, name, O_RDONLY);
  try {
    if (const std::uint64_t size = file.size(); size > kMost)
      throw std::invalid_argument(
          fmt::format("{}: has {} bytes; expected {} at most",
                      (directory / name).string(), size, kMost));
    file.read_pieces([&](std::span<const std::byte> piece) {
      text.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    });
  } catch (const std::system_error& error) {
    throw_file_error(directory / name, "cannot read", error.code());
  }
  return text;
}

std::string sha256_of_set_file(const fs::path& directory,
                               const fs::path& name) {
  OpenFile file = open_set_file(directory, name, O_RDONLY);
  try {
    return sha256_of_rest(file);
  } catch (const std::system_error& error) {
    throw_file_error(directory / name, "cannot read", error.code());
  }
}

std::optional<FileFacts> find_in_set(const fs::path& directory,
                                     const fs::path& name) {
  try {
    return Directory(directory).find(name);
  } catch (const std::system_error& error) {
    fail_on(directory / name, error.code());
  }
}

void publish_file(const fs::path& directory, const fs::path& name,
                  std::span<const std::byte> bytes) {
  const fs::path path = directory / name;
  const Directory parent = made_directory(directory, name);
  try {
    AtomicFile target(parent, name.filename().string(), path);
    target.file().write(bytes);
    target.file().seek(0);
    require_same(path, target.file(), bytes);
    target.publish();
  } catch (const FileError& error) {
    fail_publishing(path, bytes.size(), error.code);
  } catch (const std::system_error& error) {
    fail_publishing(path, bytes.size(), error.code());
  }
}

void remove_unfinished_files(const fs::path& directory, bool of_any_host) {
  const Directory set(directory);
  remove_dead_partial_files(set, of_any_host);
  const std::optional<FileFacts> source = set.find("source");
  if (source && source->is_directory)
    remove_below(set.subdirectory("source"), of_any_host);
}

}  // namespace beamgyro::internal
