// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string_view>

namespace beamgyro::internal {

/// Writes `bytes` over those of a file from `position` on. Unlike
/// write_text_file() it does not wait for the disk, so that a test may damage
/// a file thousands of times.
inline void overwrite(const std::filesystem::path& file, std::size_t position,
                      std::string_view bytes) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(position));
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  ASSERT_FALSE(stream.fail()) << file;
}

}  // namespace beamgyro::internal
