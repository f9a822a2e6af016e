// SPDX-License-Identifier: MIT
#include "dataset/set/view_check.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

#include "dataset/files/sha256.h"
#include "dataset/set/set_view.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {
namespace {

bool holds(const std::filesystem::path& file, const std::string& hash) {
  return std::filesystem::exists(file) && sha256_of_file(file) == hash;
}

}  // namespace

std::vector<FileDefect> check_views(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    std::span<const FileDefect> known) {
  std::vector<FileDefect> defects;
  if (!manifest.head || !manifest.is_finished) return defects;
  std::set<std::string> damaged;
  for (const FileDefect& defect : known) damaged.insert(defect.file);
  const auto runs = static_cast<std::uint32_t>(manifest.head->runs.size());
  for (std::uint32_t run = 0; run < runs; ++run) {
    std::vector<ManifestEntry> entries;
    for (const ManifestEntry& entry : manifest.entries) {
      if (entry.index % runs == run) entries.push_back(entry);
    }
    if (entries.empty() ||
        std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
          return damaged.contains(entry.file);
        }))
      continue;
    const std::string name = view_name(manifest.head->runs[run]);
    const ShardFile first(directory / entries.front().file);
    const std::vector<std::byte> bytes = view_bytes(first.head(), entries);
    const ManifestView expected{name, bytes.size(), sha256(bytes)};
    if (std::find(manifest.views.begin(), manifest.views.end(), expected) ==
        manifest.views.end()) {
      defects.push_back({name, "is not the view of its files", {}});
    } else if (!damaged.contains(name) &&
               !holds(directory / name, expected.sha256)) {
      defects.push_back({name, "holds other bytes than were written", {}});
    }
  }
  return defects;
}

}  // namespace beamgyro::internal
