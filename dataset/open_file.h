// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>

namespace beamgyro {

/// Owner of a file descriptor. Failures are std::system_error without the name
/// of the file. What a signal interrupts is done again.
class OpenFile {
 public:
  /// `flags` as of open(2); O_CLOEXEC comes by itself.
  OpenFile(const std::filesystem::path& path, int flags);
  /// Of a descriptor that is open; a negative one is the failed call, with its
  /// reason in errno.
  explicit OpenFile(int descriptor);
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) = delete;

  int descriptor() const { return descriptor_; }
  /// The descriptor, which somebody else closes from now on.
  int release() { return std::exchange(descriptor_, -1); }

  /// All of `bytes`, from where the file stands.
  void write(std::span<const std::byte> bytes);

  /// All of `bytes`, from byte `place` of the file on.
  void write_at(std::uint64_t place, std::span<const std::byte> bytes);

  /// Fills `bytes` from where the file stands. Returns how many there were;
  /// fewer than asked for only at the end of the file.
  std::size_t read(std::span<std::byte> bytes);

  /// The same from byte `place` of the file on.
  std::size_t read_at(std::uint64_t place, std::span<std::byte> bytes);

  /// Calls `take` with the rest of the file, piece by piece.
  void read_pieces(const std::function<void(std::span<const std::byte>)>& take);

  /// Where the file stands from now on, from its start.
  void go_to(std::uint64_t place);

  std::uint64_t size();

  /// Cuts off what is beyond `size` bytes, or adds zeros up to there.
  void resize(std::uint64_t size);

  /// That what was written is on the disk.
  void sync();

  void close();

 private:
  int descriptor_;
};

}  // namespace beamgyro
