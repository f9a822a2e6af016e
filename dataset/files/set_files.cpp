// SPDX-License-Identifier: MIT
#include "dataset/files/set_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <stdexcept>
#include <system_error>

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
  Sha256 hash;
  OpenFile file = open_set_file(directory, name, O_RDONLY);
  try {
    file.read_pieces(
        [&](std::span<const std::byte> piece) { hash.add(piece); });
  } catch (const std::system_error& error) {
    throw_file_error(directory / name, "cannot read", error.code());
  }
  return hash.digits();
}

std::optional<FileFacts> find_in_set(const fs::path& directory,
                                     const fs::path& name) {
  try {
    return Directory(directory).find(name);
  } catch (const std::system_error& error) {
    fail_on(directory / name, error.code());
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
