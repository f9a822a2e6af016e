// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {

/// Computes the SHA-256 (FIPS 180-4) of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::span<const std::byte> bytes);

  /// Returns the checksum of all pieces as 64 lower-case hexadecimal digits. No
  /// piece may follow.
  std::string digits();

 private:
  struct State;

  std::unique_ptr<State> state_;
};

/// Returns the digits of `bytes`.
std::string sha256(std::span<const std::byte> bytes);
std::string sha256(std::string_view bytes);

/// The same for the content of a file. Throws as read_text_file().
std::string sha256_of_file(const std::filesystem::path& path);

/// The same for the rest of an open file. Calls `on_piece`, if there is one,
/// with the size of each piece. Throws as OpenFile::read_pieces().
std::string sha256_of_rest(
    OpenFile& file, const std::function<void(std::size_t)>& on_piece = {});

}  // namespace beamgyro::internal
