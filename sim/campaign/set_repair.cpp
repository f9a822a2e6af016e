// SPDX-License-Identifier: MIT
#include "sim/campaign/set_repair.h"

#include <fmt/format.h>

#include <new>
#include <set>
#include <span>
#include <stdexcept>

#include "config/file_error.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

ManifestHead repairable_head(const fs::path& directory,
                             const Manifest& manifest,
                             const ProgramRevision& program) {
  if (!manifest.head || manifest.head->sources.empty())
    throw std::runtime_error(
        fmt::format("{}: the manifest has lost the line that names the "
                    "campaign; resume the generation with the campaign",
                    directory.string()));
  if (manifest.head->program_version != program.version ||
      manifest.head->git_revision != program.git_revision)
    throw std::runtime_error(fmt::format(
        "{}: was made by beamgyro {} ({}), and this is {} ({}), which may not "
        "make the same bytes; repair it with the same program",
        directory.string(), manifest.head->program_version,
        manifest.head->git_revision, program.version, program.git_revision));
  return *manifest.head;
}

CampaignPlan campaign_of(const fs::path& directory,
                         const Manifest& manifest) try {
  restore_copies(directory, manifest);
  return CampaignPlan::of_copies(read_copies(directory, *manifest.head),
                                 manifest.head->devices);
} catch (const FileError&) {
  throw;
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  // A file that cannot be read counts as damaged.
  throw std::runtime_error(
      fmt::format("{}; resume the generation with the campaign that the set "
                  "was made of",
                  error.what()));
}

}  // namespace

// Reads the manifest, or the parts of tasks that are not merged yet. If the
// manifests are lost, the copy of the first line still defines the set.
Manifest manifest_of_set(const fs::path& directory) {
  Manifest manifest;
  if (fs::is_directory(status_of(directory))) {
    if (find_in_set(directory, kManifestName))
      manifest = read_manifest(directory, kManifestName);
    if (manifest.is_finished) return manifest;
    if (!find_set(directory) && find_in_set(directory, kHeadCopyName)) {
      manifest.head = read_manifest(directory, kHeadCopyName).head;
      if (manifest.head) return manifest;
    }
  }
  const SetContents contents = set_contents(directory);
  manifest.head = contents.head;
  manifest.entries.clear();
  for (const auto& [index, entry] : contents.state.entries)
    manifest.entries.push_back(entry);
  return manifest;
}

SetRepair::SetRepair(const fs::path& directory, const Manifest& manifest,
                     const std::vector<FileDefect>& defects,
                     const ProgramRevision& program)
    : directory_(directory),
      head_(repairable_head(directory, manifest, program)),
      campaign_(campaign_of(directory, manifest)),
      plan_(campaign_, program) {
  // A manifest that says otherwise, such as one from somebody else, is not
  // followed.
  if (plan_.manifest_head() != head_)
    throw std::runtime_error(
        fmt::format("{}: the manifest is not that of the campaign beside it; "
                    "resume the generation with the campaign that the set was "
                    "made of",
                    directory.string()));
  std::set<std::uint32_t> files;
  for (const FileDefect& defect : defects)
    if (defect.index) files.insert(*defect.index);
  files_.assign(files.begin(), files.end());
  for (const ManifestEntry& entry : manifest.entries)
    hashes_.emplace(entry.index, entry.sha256);
}

void SetRepair::begin() {
  set_.emplace(directory_, head_, std::span<const SourceText>{}, SetTask{},
               true);
}

void SetRepair::add(std::uint32_t file, const MadeShard& shard) {
  const auto hash = hashes_.find(file);
  if (hash != hashes_.end() && hash->second != sha256(shard.bytes))
    throw std::runtime_error(fmt::format(
        "{}: made again it has other bytes than the manifest says; another "
        "kind of machine made it",
        expected_entry(head_, file).file));
  set_->add(file, shard.bytes, shard.failures, shard.cautions);
}

}  // namespace beamgyro::internal
