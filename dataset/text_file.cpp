// SPDX-License-Identifier: MIT
#include "dataset/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace beamgyro {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

void read_in_pieces(const std::filesystem::path& path,
                    const std::function<void(std::string_view)>& take) {
  const auto reject = [&](int error) {
    throw std::invalid_argument(
        fmt::format("{}: cannot read: {}", path.string(),
                    std::generic_category().message(error)));
  };
  std::error_code ignored;
  const auto kind = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(kind) && !std::filesystem::is_directory(kind) &&
      !std::filesystem::is_regular_file(kind)) {
    throw std::invalid_argument(
        fmt::format("{}: cannot read: it is a device or pipe; "
                    "expected a file",
                    path.string()));
  }
  const std::unique_ptr<std::FILE, CloseFile> file(
      std::fopen(path.c_str(), "rb"));
  if (!file) reject(errno);
  std::vector<char> piece(std::size_t{1} << 20);
  for (std::size_t got = piece.size(); got == piece.size();) {
    got = std::fread(piece.data(), 1, piece.size(), file.get());
    if (std::ferror(file.get()) != 0) reject(errno);
    take({piece.data(), got});
  }
}

std::string read_text_file(const std::filesystem::path& path) {
  std::string text;
  read_in_pieces(path, [&](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace beamgyro
