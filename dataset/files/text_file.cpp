// SPDX-License-Identifier: MIT
#include "dataset/files/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <span>
#include <stdexcept>
#include <system_error>

#include "config/file_error.h"
#include "config/readable_files.h"
#include "dataset/files/open_file.h"

namespace beamgyro::internal {

void read_in_pieces(const std::filesystem::path& path,
                    const std::function<void(std::string_view)>& take) {
  const auto kind = status_of(path);
  if (std::filesystem::exists(kind) && !std::filesystem::is_directory(kind) &&
      !std::filesystem::is_regular_file(kind)) {
    throw std::invalid_argument(
        fmt::format("{}: cannot read: it is a device or pipe; "
                    "expected a file",
                    path.string()));
  }
  try {
    OpenFile(path, O_RDONLY).read_pieces([&](std::span<const std::byte> piece) {
      take({reinterpret_cast<const char*>(piece.data()), piece.size()});
    });
  } catch (const std::system_error& error) {
    throw_file_error(path, "cannot read", error.code());
  }
}

std::string read_text_file(const std::filesystem::path& path) {
  require_readable(path);
  std::string text;
  read_in_pieces(path, [&](std::string_view piece) { text += piece; });
  return text;
}

std::string read_json_text(const std::filesystem::path& path,
                           std::string_view kind) {
  require_readable(path);
  std::string text;
  read_in_pieces(path, [&](std::string_view piece) {
    text += piece;
    if (text.size() <= kLargestJson) return;
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    throw std::invalid_argument(fmt::format(
        "{}: {} bytes; expected {}, which has at most {}", path.string(),
        unknown ? text.size() : size, kind, kLargestJson));
  });
  return text;
}

}  // namespace beamgyro::internal
