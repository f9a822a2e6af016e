// SPDX-License-Identifier: MIT
#include "dataset/files/publish.h"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/open_file.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

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

}  // namespace beamgyro::internal
