// SPDX-License-Identifier: MIT
#include "dataset/files/file_checksum.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kStart = "\nSHA-256 of all bytes before: ";
constexpr std::size_t kLine = kStart.size() + 64 + 1;

std::string line_of(const std::string& digits) {
  return std::string(kStart) + digits + '\n';
}

/// SHA-256 of the first `size` bytes.
std::string digits_of(OpenFile& file, std::uint64_t size) {
  file.seek(0);
  Sha256 hash;
  file.read_pieces([&](std::span<const std::byte> piece) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), size));
    hash.add(piece.first(count));
    size -= count;
  });
  return hash.digits();
}

/// The line at the end of `file`, or an empty text.
std::string last_line(OpenFile& file, std::uint64_t size) {
  if (size < kLine) return {};
  std::string line(kLine, '\0');
  line.resize(
      file.read_at(size - kLine, std::as_writable_bytes(std::span(line))));
  return line.starts_with(kStart) ? line : std::string();
}

}  // namespace

void append_checksum(OpenFile& file) {
  const std::uint64_t size = file.size();
  const std::string line = line_of(digits_of(file, size));
  file.write_at(size, std::as_bytes(std::span(line)));
}

FileChecksum checksum_of(OpenFile& file) {
  const std::uint64_t size = file.size();
  const std::string line = last_line(file, size);
  if (line.empty()) return FileChecksum::kNone;
  return line == line_of(digits_of(file, size - kLine)) ? FileChecksum::kRight
                                                        : FileChecksum::kWrong;
}

bool has_bytes_after_hdf5(OpenFile& file) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  // Where versions 0 to 3 of the first block have the length of the file.
  constexpr std::array<std::size_t, 4> kEnd = {40, 44, 28, 28};
  std::array<std::byte, 52> block{};
  if (file.read_at(0, block) < block.size()) return false;
  if (std::memcmp(block.data(), kSignature.data(), kSignature.size()) != 0)
    return false;
  const auto version = std::to_integer<std::size_t>(block[kSignature.size()]);
  if (version >= kEnd.size()) return false;
  std::uint64_t end = 0;
  std::memcpy(&end, block.data() + kEnd.at(version), sizeof end);
  return file.size() > end && last_line(file, file.size()).empty();
}

bool has_checksum(OpenFile& file) {
  return !last_line(file, file.size()).empty();
}

}  // namespace beamgyro::internal
