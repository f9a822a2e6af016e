// SPDX-License-Identifier: MIT
#include "dataset/files/made_directories.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "config/file_error.h"

namespace beamgyro::internal {

MadeDirectories::MadeDirectories(const std::filesystem::path& path) {
  try {
    std::filesystem::path place;
    for (const std::filesystem::path& part : path) {
      place /= part;
      if (uninterrupted([&] { return mkdir(place.c_str(), 0777); }) == 0)
        made_.push_back(place);
      else if (errno != EEXIST)
        throw_file_error(path, "cannot make this directory",
                         {errno, std::generic_category()},
                         "one that is there or can be made");
    }
    if (!std::filesystem::is_directory(status_of(path)))
      throw std::invalid_argument(fmt::format(
          "{}: is no directory; expected one that is there or can be made",
          path.string()));
  } catch (...) {
    remove_empty();
    throw;
  }
}

void MadeDirectories::remove_empty() noexcept {
  for (; !made_.empty(); made_.pop_back()) rmdir(made_.back().c_str());
}

}  // namespace beamgyro::internal
