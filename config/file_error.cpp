// SPDX-License-Identifier: MIT
#include "config/file_error.h"

#include <fmt/format.h>

namespace beamgyro::internal {

bool is_wrong_name(const std::error_code& error) {
  for (const std::errc wrong :
       {std::errc::no_such_file_or_directory, std::errc::not_a_directory,
        std::errc::is_a_directory, std::errc::permission_denied,
        std::errc::operation_not_permitted, std::errc::read_only_file_system,
        std::errc::too_many_symbolic_link_levels,
        std::errc::filename_too_long}) {
    if (error == wrong) return true;
  }
  return false;
}

void throw_file_error(const std::filesystem::path& path,
                      std::string_view action, const std::error_code& error,
                      std::string_view expected) {
  const bool names_expected = !expected.empty() && is_wrong_name(error);
  const std::string what =
      fmt::format("{}: {}: {}{}{}", path.string(), action, error.message(),
                  names_expected ? "; expected " : "",
                  names_expected ? expected : std::string_view());
  if (is_wrong_name(error)) throw std::invalid_argument(what);
  throw FileError(what, error);
}

std::filesystem::file_status status_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status =
      std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::none)
    throw_file_error(path, "cannot read", error);
  return status;
}

}  // namespace beamgyro::internal
