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

/// Calls `call` with the bytes that are done until it has done `size`, or does
/// none, which only a read at the end of a file does. Returns their number.
template <class Call>
std::size_t transfer(std::size_t size, const Call& call) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = uninterrupted([&] { return call(done); });
    if (count < 0) fail_opening();
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
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
  transfer(bytes.size(), [&](std::size_t done) {
    return ::write(descriptor_, bytes.data() + done, bytes.size() - done);
  });
}

void OpenFile::write_at(std::uint64_t place, std::span<const std::byte> bytes) {
  transfer(bytes.size(), [&](std::size_t done) {
    return ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                    static_cast<off_t>(place + done));
  });
}

std::size_t OpenFile::read(std::span<std::byte> bytes) {
  return transfer(bytes.size(), [&](std::size_t done) {
    return ::read(descriptor_, bytes.data() + done, bytes.size() - done);
  });
}

std::size_t OpenFile::read_at(std::uint64_t place, std::span<std::byte> bytes) {
  return transfer(bytes.size(), [&](std::size_t done) {
    return ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                   static_cast<off_t>(place + done));
  });
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
