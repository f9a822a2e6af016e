// SPDX-License-Identifier: MIT
#include "dataset/set/source_copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "dataset/set/publish.h"
#include "dataset/sha256.h"
#include "dataset/text_file.h"

namespace beamgyro {
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
    entries.push_back({name, sha256(file.text)});
  }
  return entries;
}

void copy_sources(const fs::path& directory,
                  std::span<const SourceText> files) {
  const fs::path common = common_directory(files);
  for (const SourceText& file : files) {
    const fs::path copy = directory / copy_name(common, file);
    if (fs::exists(copy) && read_text_file(copy) == file.text) continue;
    fs::create_directories(copy.parent_path());
    publish_file(copy, std::as_bytes(std::span(file.text)));
  }
}

}  // namespace beamgyro
