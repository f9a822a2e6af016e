// SPDX-License-Identifier: MIT
#include "dataset/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace beamgyro {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string read_text_file(const std::filesystem::path& path) {
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
  std::string bytes;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  for (std::size_t got = kBlock; got == kBlock;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kBlock);
    got = std::fread(bytes.data() + before, 1, kBlock, file.get());
    if (std::ferror(file.get()) != 0) reject(errno);
    bytes.resize(before + got);
  }
  return bytes;
}

}  // namespace beamgyro
