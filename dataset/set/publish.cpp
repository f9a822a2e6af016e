// SPDX-License-Identifier: MIT
#include "dataset/set/publish.h"

#include <fcntl.h>
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

#include "dataset/atomic_file.h"
#include "dataset/open_file.h"

namespace beamgyro {
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

[[noreturn]] void fail(const fs::path& path, std::size_t size,
                       const std::error_code& error) {
  const bool is_full =
      error == std::errc::no_space_on_device ||
      error == std::error_code(EDQUOT, std::generic_category());
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}; {} bytes are needed{}", path.string(),
                  error.message(), size, is_full ? room_in(path) : ""));
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

}  // namespace

void sync_directory(const fs::path& directory) {
  const fs::path& name = directory.empty() ? fs::path(".") : directory;
  try {
    OpenFile(name, O_RDONLY | O_DIRECTORY).sync();
  } catch (const std::system_error& error) {
    // Some network file systems cannot, and need not.
    if (error.code() == std::errc::invalid_argument) return;
    throw std::runtime_error(fmt::format("{}: cannot write: {}", name.string(),
                                         error.code().message()));
  }
}

void publish_file(const fs::path& path, std::span<const std::byte> bytes) {
  AtomicFile target(path);
  try {
    OpenFile file(target.partial_path(), O_WRONLY);
    file.write(bytes);
    file.sync();
    file.close();
    OpenFile written(target.partial_path(), O_RDONLY);
    require_same(path, written, bytes);
  } catch (const std::system_error& error) {
    fail(path, bytes.size(), error.code());
  }
  target.publish();
  sync_directory(path.parent_path());
}

}  // namespace beamgyro
