// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace beamgyro::internal {

/// Thrown when work on a file fails although its name is right: a failing or
/// full disk, a server that is gone, too many open files.
struct FileError : std::runtime_error {
  FileError(const std::string& what, const std::error_code& why)
      : std::runtime_error(what), code(why) {}
  std::error_code code;
};

/// Returns whether an error means that the given name is wrong: there is no
/// such file, it is a directory, access is denied, and so on.
bool is_wrong_name(const std::error_code& error);

/// Throws "PATH: ACTION: REASON; expected EXPECTED" as std::invalid_argument
/// for a wrong name (wrong input), and "PATH: ACTION: REASON" as FileError for
/// any other error (failed work). The last part of the first message is left
/// out if `expected` is empty. Only this function decides between the two.
[[noreturn]] void throw_file_error(const std::filesystem::path& path,
                                   std::string_view action,
                                   const std::error_code& error,
                                   std::string_view expected = {});

/// Returns the status of the file that `path` names, with links followed, or
/// file_type::not_found when there is none. Throws as throw_file_error() when
/// the status cannot be determined.
std::filesystem::file_status status_of(const std::filesystem::path& path);

/// Repeats a system call while signals interrupt it, and returns its result.
template <class Call>
auto uninterrupted(const Call& call) {
  auto answer = call();
  while (answer == -1 && errno == EINTR) answer = call();
  return answer;
}

}  // namespace beamgyro::internal
