// SPDX-License-Identifier: MIT
#include "cli/inputs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "cli/terminal.h"
#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/directory.h"
#include "dataset/files/file_ending.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

/// Device and inode of a file, which are the same under all its names.
using FileIdentity = std::pair<dev_t, ino_t>;

/// Follows links. Returns nothing when there is no such file.
std::optional<FileIdentity> identity_of(const fs::path& path) {
  struct stat facts {};
  if (uninterrupted([&] { return ::stat(path.c_str(), &facts); }) == 0)
    return FileIdentity{facts.st_dev, facts.st_ino};
  const std::error_code error(errno, std::generic_category());
  if (!is_wrong_name(error)) throw_file_error(path, "cannot read", error);
  return {};
}

/// Returns no names when there is no such directory.
std::vector<std::string> files_below(const fs::path& directory) {
  try {
    return Directory(directory).files_below();
  } catch (const std::system_error& error) {
    if (!is_wrong_name(error.code()))
      throw_file_error(directory, "cannot read", error.code());
    return {};
  }
}

bool is_below(const fs::path& directory, const FileIdentity& identity) {
  const std::vector<std::string> files = files_below(directory);
  return std::any_of(files.begin(), files.end(), [&](const auto& name) {
    return identity_of(directory / name) == identity;
  });
}

[[noreturn]] void refuse(const fs::path& output, const char* expected) {
  throw std::invalid_argument(fmt::format("{}: is read by this command; {}",
                                          output.string(), expected));
}

}  // namespace

Recording load_recording(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Recording recording = beamgyro::read_recording(path, &warnings);
  for (const std::string& warning : warnings) keep_warning(warning);
  return recording;
}

void require_ending(const fs::path& path,
                    const std::vector<std::string>& endings) {
  const std::string extension = file_ending(path);
  if (std::ranges::count(endings, extension) > 0) return;
  throw std::invalid_argument(fmt::format(
      "-o {}: unknown kind of file \"{}\"; expected a name that ends in {}",
      path.string(), extension, fmt::join(endings, " or ")));
}

void require_recording_name(const fs::path& path) {
  require_ending(path, {".h5", ".csv"});
}

void require_directory_name(const fs::path& path, std::string_view option) {
  const std::string extension = file_ending(path);
  for (const char* ending :
       {".h5", ".nc", ".csv", ".json", ".toml", ".c", ".h"}) {
    if (extension == ending)
      throw std::invalid_argument(
          fmt::format("{} {}: is the name of a file; expected that of a "
                      "directory",
                      option, path.string()));
  }
}

void require_output(const fs::path& output,
                    const std::vector<fs::path>& inputs) {
  if (const auto there = identity_of(output)) {
    for (const fs::path& input : inputs) {
      if (identity_of(input) == there || is_below(input, *there))
        refuse(output, "expected another name for what it writes");
    }
  }
  require_writable(output);
  set_interrupt_note(fmt::format(
      "{} {}", output.string(),
      identity_of(output) ? "is as it was before" : "was not written"));
}

void require_json_output(const std::string& name,
                         const std::vector<fs::path>& inputs,
                         std::string_view option) {
  if (name.empty()) return;
  require_output(name, inputs);
  const std::string extension = file_ending(name);
  for (const char* other : {".h5", ".nc", ".csv", ".toml", ".c", ".h"})
    if (extension == other)
      throw std::invalid_argument(fmt::format(
          "{} {}: is the name of a file of another kind (\"{}\"); expected "
          "one that ends in .json",
          option, name, extension));
}

void require_output_directory(const char* option, const std::string& name,
                              const char* file,
                              const std::vector<fs::path>& inputs) {
  if (name.empty()) return;
  require_directory_name(name, option);
  try {
    const MadeDirectories made(name);
    require_output(fs::path(name) / file, inputs);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{} {}", option, error.what()));
  }
}

void require_set_output(const fs::path& directory, const ManifestHead& head,
                        const std::vector<SourceText>& inputs) {
  std::set<FileIdentity> read;
  for (const SourceText& input : inputs)
    if (const auto identity = identity_of(input.path)) read.insert(*identity);
  // Copies with the right bytes will not be written.
  std::map<std::string, std::string> copies;
  for (const SourceEntry& source : head.sources)
    copies.emplace(source.file, source.sha256);
  for (const std::string& name : files_below(directory)) {
    const fs::path file = directory / name;
    const std::string kind = file.extension().string();
    const auto copy = copies.find(name);
    const bool is_written =
        copy != copies.end()
            ? sha256_of_file(file) != copy->second
            : name == kHeadCopyName || (!fs::path(name).has_parent_path() &&
                                        (kind == ".h5" || kind == ".nc" ||
                                         kind == ".jsonl" || kind == ".lock"));
    if (!is_written) continue;
    if (const auto there = identity_of(file); there && read.contains(*there))
      refuse(file, "expected another directory for what it writes");
  }
}

}  // namespace beamgyro::internal
