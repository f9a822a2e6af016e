// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>

namespace beamgyro::internal {

/// Owner of a file descriptor. Failures are std::system_error without the name
/// of the file. Calls that a signal interrupts are repeated.
class OpenFile {
 public:
  /// Opens a file. `flags` are those of open(2); O_CLOEXEC is added.
  OpenFile(const std::filesystem::path& path, int flags);
  /// Takes over an open descriptor. A negative one is a failed call with its
  /// reason in errno, and throws.
  explicit OpenFile(int descriptor);
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) = delete;

  int descriptor() const { return descriptor_; }
  /// Returns the descriptor, which the caller has to close.
  int release() { return std::exchange(descriptor_, -1); }

  /// Writes all of `bytes` at the present position.
  void write(std::span<const std::byte> bytes);

  /// Writes all of `bytes` from byte `place` of the file.
  void write_at(std::uint64_t place, std::span<const std::byte> bytes);

  /// Fills `bytes` from the present position. Returns the number of bytes read,
  /// which is smaller than asked for only at the end of the file.
  std::size_t read(std::span<std::byte> bytes);

  /// The same from byte `place` of the file.
  std::size_t read_at(std::uint64_t place, std::span<std::byte> bytes);

  /// Calls `take` with the rest of the file, piece by piece.
  void read_pieces(const std::function<void(std::span<const std::byte>)>& take);

  /// Sets the position, counted from the start of the file.
  void seek(std::uint64_t place);

  std::uint64_t size();

  /// Sets the size of the file: cuts off bytes beyond `size`, or adds zeros up
  /// to it.
  void resize(std::uint64_t size);

  /// Synchronises what was written with the disk.
  void sync();

  void close();

 private:
  int descriptor_;
};

}  // namespace beamgyro::internal
