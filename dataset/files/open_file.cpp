// SPDX-License-Identifier: MIT
#include "dataset/files/open_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "config/file_error.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void fail_opening() {
  throw std::system_error(errno, std::generic_category());
}

}  // namespace

OpenFile::OpenFile(const std::filesystem::path& path, int flags)
    : OpenFile(uninterrupted(
          [&] { return ::open(path.c_str(), flags | O_CLOEXEC, 0666); })) {}

OpenFile::OpenFile(int descriptor) : descriptor_(descriptor) {
  if (descriptor_ < 0) fail_opening();
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OpenFile::OpenFile(OpenFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

void OpenFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      fail_opening();
    }
  }
}

void OpenFile::write_at(std::uint64_t place, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(),
                                   static_cast<off_t>(place));
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      place += static_cast<std::uint64_t>(count);
    } else if (errno != EINTR) {
      fail_opening();
    }
  }
}

std::size_t OpenFile::read(std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::read(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count == 0) break;
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      fail_opening();
    }
  }
  return done;
}

std::size_t OpenFile::read_at(std::uint64_t place, std::span<std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                static_cast<off_t>(place + done));
    if (count == 0) break;
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      fail_opening();
    }
  }
  return done;
}

void OpenFile::read_pieces(
    const std::function<void(std::span<const std::byte>)>& take) {
  std::vector<std::byte> piece(std::size_t{1} << 20);
  for (std::size_t got = piece.size(); got == piece.size();) {
    got = read(piece);
    take(std::span(piece).first(got));
  }
}

void OpenFile::seek(std::uint64_t place) {
  if (lseek(descriptor_, static_cast<off_t>(place), SEEK_SET) < 0)
    fail_opening();
}

std::uint64_t OpenFile::size() {
  struct stat facts {};
  if (fstat(descriptor_, &facts) != 0) fail_opening();
  return static_cast<std::uint64_t>(facts.st_size);
}

void OpenFile::resize(std::uint64_t size) {
  const auto length = static_cast<off_t>(size);
  if (uninterrupted([&] { return ftruncate(descriptor_, length); }) != 0)
    fail_opening();
}

void OpenFile::sync() {
  if (uninterrupted([&] { return ::fsync(descriptor_); }) != 0) fail_opening();
}

void OpenFile::close() {
  // Linux releases the descriptor before a signal can interrupt the call.
  // Closing it again might close the file of another thread.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
    fail_opening();
}

}  // namespace beamgyro::internal
