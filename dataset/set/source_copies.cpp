// SPDX-License-Identifier: MIT
#include "dataset/set/source_copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

fs::path placed(const fs::path& path) {
  return fs::absolute(path).lexically_normal();
}

/// The longest directory that all files are in.
fs::path common_directory(std::span<const SourceText> files) {
  if (files.empty()) return {};
  fs::path common = placed(files.front().path).parent_path();
  for (const SourceText& file : files) {
    const fs::path other = placed(file.path).parent_path();
    const auto [end, ignored] =
        std::mismatch(common.begin(), common.end(), other.begin(), other.end());
    fs::path shorter;
    for (auto part = common.begin(); part != end; ++part) shorter /= *part;
    common = shorter;
  }
  return common;
}

std::string copy_name(const fs::path& common, const SourceText& file) {
  return ("source" / placed(file.path).lexically_relative(common)).string();
}

/// How many directories and names at their ends two paths have in common.
std::ptrdiff_t same_end(const fs::path& a, const fs::path& b) {
  const std::vector<fs::path> of_a(a.begin(), a.end());
  const std::vector<fs::path> of_b(b.begin(), b.end());
  return std::mismatch(of_a.rbegin(), of_a.rend(), of_b.rbegin(), of_b.rend())
             .first -
         of_a.rbegin();
}

bool is_whole(const fs::path& directory, const SourceEntry& source) {
  try {
    return sha256_of_set_file(directory, source.file) == source.sha256;
  } catch (const std::invalid_argument&) {
    return false;  // missing, or no ordinary file
  }
}

/// Those that the first whole file of a run keeps below /meta.
std::vector<std::string> texts_of_run(const fs::path& directory,
                                      const Manifest& manifest,
                                      std::size_t run) {
  std::map<std::string, ManifestEntry> listed;
  for (const ManifestEntry& entry : manifest.entries)
    listed.emplace(entry.file, entry);
  const std::uint32_t files = file_count(*manifest.head);
  const auto runs = static_cast<std::uint32_t>(manifest.head->runs.size());
  for (auto index = static_cast<std::uint32_t>(run); index < files;
       index += runs) {
    const std::string name = expected_entry(*manifest.head, index).file;
    const auto entry = listed.find(name);
    try {
      const ShardFile file =
          entry == listed.end()
              ? ShardFile(directory, name)
              : ShardFile(directory / name,
                          open_listed(directory, entry->second));
      return {file.head().campaign_text, file.head().device_text,
              file.head().scenario_text};
    } catch (const std::invalid_argument&) {
      // Missing or damaged; another may serve.
    }
  }
  return {};
}

void require_utf8(const std::string& name) {
  try {
    static_cast<void>(nlohmann::json(name).dump());
  } catch (const nlohmann::json::type_error&) {
    throw std::invalid_argument(
        fmt::format("{}: the name is not UTF-8, which the manifest is", name));
  }
}

}  // namespace

std::vector<SourceEntry> source_entries(std::span<const SourceText> files) {
  std::vector<SourceEntry> entries;
  std::set<std::string> done;
  const fs::path common = common_directory(files);
  for (const SourceText& file : files) {
    const std::string name = copy_name(common, file);
    if (!done.insert(name).second) continue;
    require_utf8(name);
    if (name == kHeadCopyName)
      throw std::invalid_argument(fmt::format(
          "{}: the set keeps something else under the name {}; expected "
          "another name",
          file.path.string(), name));
    entries.push_back({name, sha256(file.text)});
  }
  return entries;
}

void copy_sources(const fs::path& directory,
                  std::span<const SourceText> files) {
  const fs::path common = common_directory(files);
  for (const SourceText& file : files) {
    const std::string copy = copy_name(common, file);
    const std::optional<FileFacts> there = find_in_set(directory, copy);
    if (there && there->is_regular && there->bytes == file.text.size() &&
        read_set_file(directory, copy) == file.text)
      continue;
    publish_file(directory, copy, std::as_bytes(std::span(file.text)));
  }
}

std::vector<SourceText> read_copies(const fs::path& directory,
                                    const ManifestHead& head) {
  if (head.sources.empty())
    throw std::runtime_error(
        fmt::format("{}: the manifest names no campaign", directory.string()));
  std::vector<SourceText> copies;
  for (const SourceEntry& source : head.sources) {
    const fs::path path = directory / source.file;
    try {
      copies.push_back({path, read_set_file(directory, source.file)});
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(error.what());
    }
    if (sha256(copies.back().text) != source.sha256)
      throw std::runtime_error(fmt::format(
          "{}: holds other bytes than were written", path.string()));
  }
  return copies;
}

void restore_copies(const fs::path& directory, const Manifest& manifest) {
  std::vector<SourceEntry> lost;
  for (const SourceEntry& source : manifest.head->sources)
    if (!is_whole(directory, source)) lost.push_back(source);
  if (lost.empty()) return;
  for (std::size_t run = 0; run < manifest.head->runs.size(); ++run) {
    for (const std::string& text : texts_of_run(directory, manifest, run)) {
      for (const SourceEntry& source : lost) {
        if (sha256(text) == source.sha256)
          publish_file(directory, source.file, std::as_bytes(std::span(text)));
      }
    }
  }
}

const SourceText& copy_of(const fs::path& path,
                          std::span<const SourceText> copies) {
  const fs::path wanted = path.lexically_normal();
  const SourceText* best = nullptr;
  std::ptrdiff_t most = 0;
  bool is_only = true;
  for (const SourceText& copy : copies) {
    const fs::path there = copy.path.lexically_normal();
    if (there == wanted) return copy;
    const std::ptrdiff_t same = same_end(wanted, there);
    if (same > most) best = &copy;
    if (same >= most) is_only = same > most;
    most = std::max(most, same);
  }
  if (best == nullptr || !is_only)
    throw std::invalid_argument(fmt::format(
        "{}: the set has no copy of it; expected one of every file that its "
        "campaign names",
        path.string()));
  return *best;
}

}  // namespace beamgyro::internal
