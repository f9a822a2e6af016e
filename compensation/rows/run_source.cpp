// SPDX-License-Identifier: MIT
#include "compensation/rows/run_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "config/file_error.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {

RunSource source_of(const std::vector<TrainingRun>& runs) {
  return {runs.size(), [&runs](const RunSource::Visitor& visit) {
            for (const TrainingRun& run : runs) visit(run);
          }};
}

RunSource runs_of_files(
    const std::vector<std::string>& paths,
    const std::function<Recording(const std::filesystem::path&)>& read) {
  return {paths.size(), [&paths, read](const RunSource::Visitor& visit) {
            for (const std::string& path : paths)
              visit({std::filesystem::path(path).filename().string(),
                     sha256_of_file(path), read(path)});
          }};
}

void require_different_runs(const std::vector<std::string>& paths) {
  std::map<std::uintmax_t, std::vector<std::string>> of_size;  // [bytes]
  for (const std::string& path : paths) {
    std::error_code error;  // shows when the run is read
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error) of_size[size].push_back(path);
  }
  for (const auto& [size, names] : of_size) {
    std::map<std::string, std::string> of_hash;
    if (names.size() < 2) continue;
    for (const std::string& name : names) {
      const auto [same, is_new] = of_hash.emplace(sha256_of_file(name), name);
      if (!is_new)
        throw std::invalid_argument(
            fmt::format("{}: is the same recording as {}; expected each once: "
                        "leave one of them out",
                        name, same->second));
    }
  }
}

namespace {

// Devices of one file of the set.
struct FileMembers {
  std::filesystem::path directory;
  std::string file, run;
  std::vector<std::uint32_t> positions;
  std::size_t group = 0;  // files of the same devices have one number
};

template <class T>
bool holds(const std::vector<T>& all, const T& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

void check_selection(const ManifestHead& head, const SetSelection& selection,
                     const std::string& place) {
  for (const std::string& run : selection.runs)
    if (!holds(head.runs, run))
      throw std::invalid_argument(
          fmt::format("{}: the set has no run \"{}\"; its runs are {}", place,
                      run, fmt::join(head.runs, ", ")));
  for (const std::uint32_t device : selection.devices)
    if (device >= head.devices)
      throw std::invalid_argument(
          fmt::format("{}: device {}; the set has devices 0 to {}", place,
                      device, head.devices - 1));
}

bool is_selected(const SetSelection& selection, std::uint32_t device,
                 const DeviceRow& row) {
  return row.failure.empty() &&
         (!selection.part ||
          row.part == static_cast<std::uint8_t>(*selection.part)) &&
         (selection.devices.empty() || holds(selection.devices, device));
}

void visit_device(const FileMembers& members, const ShardFile& shard,
                  std::uint32_t position, const RunSource::Visitor& visit) {
  const auto device = fmt::format("{}", shard.head().first_device + position);
  visit({fmt::format("{}, device {}", members.file, device), "",
         shard.recording(position), device, members.run});
}

void visit_file(const FileMembers& members, const RunSource::Visitor& visit) {
  const ShardFile shard(members.directory, members.file);
  for (const std::uint32_t position : members.positions)
    visit_device(members, shard, position, visit);
}

// Visits the runs of some devices, which are in a file each.
void visit_files_by_device(std::span<const FileMembers> files,
                           const RunSource::Visitor& visit) {
  std::deque<ShardFile> shards;  // stay where they are
  std::set<std::uint32_t> positions;
  for (const FileMembers& members : files) {
    shards.emplace_back(members.directory, members.file);
    positions.insert(members.positions.begin(), members.positions.end());
  }
  for (const std::uint32_t position : positions)
    for (std::size_t k = 0; k < files.size(); ++k)
      if (holds(files[k].positions, position))
        visit_device(files[k], shards[k], position, visit);
}

void visit_by_device(const std::vector<FileMembers>& files,
                     const RunSource::Visitor& visit) {
  for (auto begin = files.begin(); begin != files.end();) {
    const auto end = std::find_if(begin, files.end(), [&](const auto& members) {
      return members.group != begin->group;
    });
    visit_files_by_device({begin, end}, visit);
    begin = end;
  }
}

}  // namespace

RunSource runs_of_set(const std::filesystem::path& directory,
                      const SetSelection& selection) {
  const Manifest manifest = finished_manifest(directory);
  check_selection(*manifest.head, selection, directory.string());
  std::vector<FileMembers> files;
  std::set<std::uint32_t> devices;
  std::size_t count = 0;
  const std::vector<std::string>& runs = manifest.head->runs;
  for (const ManifestEntry& entry : manifest.entries) {
    const std::string& run = runs[entry.index % runs.size()];
    if (!selection.runs.empty() && !holds(selection.runs, run)) continue;
    FileMembers members{
        directory, entry.file, run, {}, entry.index / runs.size()};
    const ShardFile shard(directory / entry.file,
                          open_listed(directory, entry));
    for (std::uint32_t k = 0; k < shard.devices(); ++k) {
      const std::uint32_t device = shard.head().first_device + k;
      if (!is_selected(selection, device, shard.row(k))) continue;
      members.positions.push_back(k);
      devices.insert(device);
    }
    count += members.positions.size();
    if (!members.positions.empty()) files.push_back(std::move(members));
  }
  RunSource source;
  source.count = count;
  source.set = TrainingSet{
      std::filesystem::weakly_canonical(directory).filename().string(),
      sha256_of_set_file(directory, kManifestName),
      devices.size(),
      files.size(),
      manifest.head->campaign_sha256,
      manifest.head->seed,
      selection.runs.empty() ? runs : selection.runs,
      {devices.begin(), devices.end()}};
  source.for_each_by_device = [files](const RunSource::Visitor& visit) {
    visit_by_device(files, visit);
  };
  source.for_each = [files =
                         std::move(files)](const RunSource::Visitor& visit) {
    for (const FileMembers& members : files) visit_file(members, visit);
  };
  return source;
}

}  // namespace beamgyro::internal
