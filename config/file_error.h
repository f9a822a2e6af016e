// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace beamgyro {

/// Work on a file that failed although its name serves: a failing or full disk,
/// a server that is gone, too many open files.
struct FileError : std::runtime_error {
  FileError(const std::string& what, const std::error_code& why)
      : std::runtime_error(what), code(why) {}
  std::error_code code;
};

/// Whether an error means that the name asked for is wrong: nothing is there,
/// it is a directory, access is denied, and so on.
bool is_wrong_name(const std::error_code& error);

/// Throws "PATH: ACTION: REASON; expected EXPECTED", the last part unless it is
/// empty: std::invalid_argument for a wrong name, which is wrong input, and
/// FileError for any other error, which is failed work. Nobody else decides
/// between the two.
[[noreturn]] void throw_file_error(const std::filesystem::path& path,
                                   std::string_view action,
                                   const std::error_code& error,
                                   std::string_view expected = {});

/// What `path` names, links followed; file_type::not_found when nothing is
/// there. Throws as throw_file_error() when that cannot be told.
std::filesystem::file_status status_of(const std::filesystem::path& path);

/// The answer of a system call that is made anew while signals interrupt it.
template <class Call>
auto uninterrupted(const Call& call) {
  auto answer = call();
  while (answer == -1 && errno == EINTR) answer = call();
  return answer;
}

}  // namespace beamgyro
