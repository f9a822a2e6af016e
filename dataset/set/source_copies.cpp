// SPDX-License-Identifier: MIT
#include "dataset/set/source_copies.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "dataset/set/publish.h"
#include "dataset/sha256.h"

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

void require_utf8(const std::string& name) {
  try {
    static_cast<void>(nlohmann::json(name).dump());
  } catch (const nlohmann::json::type_error&) {
    throw std::invalid_argument(
        fmt::format("{}: the name is not UTF-8, which the manifest is", name));
  }
}

}  // namespace

std::vector<SourceEntry> copy_sources(const fs::path& directory,
                                      std::span<const SourceText> files) {
  const fs::path common = common_directory(files);
  std::vector<SourceEntry> entries;
  std::set<fs::path> done;
  for (const SourceText& file : files) {
    const fs::path name =
        "source" / placed(file.path).lexically_relative(common);
    if (!done.insert(name).second) continue;
    require_utf8(name.string());
    fs::create_directories((directory / name).parent_path());
    publish_file(directory / name, std::as_bytes(std::span(file.text)));
    entries.push_back({name.string(), sha256(file.text)});
  }
  return entries;
}

}  // namespace beamgyro
