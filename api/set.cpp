// SPDX-License-Identifier: MIT
#include "include/beamgyro/set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "api/program_version.h"
#include "api/reported_progress.h"
#include "api/set_defects.h"
#include "api/shared_maker.h"
#include "dataset/set/manifest.h"
#include "dataset/set/set_view.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro {
namespace internal {

std::vector<FileDefect> set_defects(const std::filesystem::path& directory,
                                    const Manifest& manifest,
                                    const CheckProgress& progress) {
  std::vector<FileDefect> defects = check_set(directory, manifest, progress);
  // Another program may make views of other bytes.
  if (manifest.head && manifest.head->program_version == kProgramVersion &&
      manifest.head->git_revision == kGitRevision)
    std::ranges::copy(check_views(directory, manifest, defects),
                      std::back_inserter(defects));
  return defects;
}

class OpenSet {
 public:
  /// Place of a device in a file.
  struct Place {
    std::shared_ptr<const ShardFile> file;
    std::uint32_t position;
  };

  std::filesystem::path directory;
  Manifest manifest;  // finished
  std::vector<SetFailure> failures;

  const ManifestHead& head() const { return *manifest.head; }

  /// Opens the file, compares its bytes with the manifest, and keeps the few
  /// that were used last open. Throws as Set::part().
  Place place_of(std::string_view run, std::uint32_t device) const;

 private:
  std::shared_ptr<const ShardFile> file_of(std::uint32_t index) const;

  mutable std::mutex mutex_;
  mutable std::map<std::uint32_t, std::shared_ptr<const ShardFile>> open_;
};

namespace {

constexpr std::size_t kMostOpen = 8;  // files of a set

std::vector<SetFailure> failures_of(const Manifest& manifest) {
  std::vector<SetFailure> failures;
  const std::vector<std::string>& runs = manifest.head->runs;
  for (const ManifestEntry& entry : manifest.entries)
    for (const DeviceFailure& failure : entry.failures)
      failures.push_back(
          {runs[entry.index % runs.size()], failure.device, failure.reason});
  return failures;
}

}  // namespace

std::shared_ptr<const ShardFile> OpenSet::file_of(std::uint32_t index) const {
  const std::lock_guard lock(mutex_);
  if (const auto found = open_.find(index); found != open_.end())
    return found->second;
  const auto entry =
      std::ranges::find(manifest.entries, index, &ManifestEntry::index);
  auto file = std::make_shared<const ShardFile>(directory / entry->file,
                                                open_listed(directory, *entry));
  if (open_.size() >= kMostOpen) open_.erase(open_.begin());
  open_.emplace(index, file);
  return file;
}

OpenSet::Place OpenSet::place_of(std::string_view run,
                                 std::uint32_t device) const {
  const std::vector<std::string>& runs = head().runs;
  const auto named = std::ranges::find(runs, run);
  if (named == runs.end())
    throw std::invalid_argument(
        fmt::format("{}: the set has no run \"{}\"; its runs are {}",
                    directory.string(), run, fmt::join(runs, ", ")));
  if (device >= head().devices)
    throw std::invalid_argument(
        fmt::format("{}: device {}; the set has devices 0 to {}",
                    directory.string(), device, head().devices - 1));
  const std::uint32_t range = device / head().devices_per_file;
  const auto index = static_cast<std::uint32_t>(range * runs.size()) +
                     static_cast<std::uint32_t>(named - runs.begin());
  return {file_of(index), device % head().devices_per_file};
}

}  // namespace internal

std::string_view part_name(SetPart part) {
  switch (part) {
    case SetPart::kTrain:
      return "train";
    case SetPart::kValidation:
      return "validation";
    case SetPart::kTest:
      return "test";
  }
  return {};
}

Set Set::open(const std::filesystem::path& directory) {
  auto state = std::make_shared<internal::OpenSet>();
  state->directory = directory;
  state->manifest = internal::finished_manifest(directory);
  state->failures = internal::failures_of(state->manifest);
  return internal::SharedMaker::make<Set>(std::move(state));
}

std::filesystem::path Set::directory() const { return content().directory; }
std::string Set::campaign() const { return content().head().campaign; }
std::uint32_t Set::devices() const { return content().head().devices; }
std::vector<std::string> Set::runs() const { return content().head().runs; }
std::uint64_t Set::seed() const { return content().head().seed; }
std::string Set::program_version() const {
  return content().head().program_version;
}
std::string Set::git_revision() const { return content().head().git_revision; }
std::vector<SetFailure> Set::failures() const { return content().failures; }

SetPart Set::part(std::uint32_t device) const {
  const internal::OpenSet::Place place =
      content().place_of(content().head().runs.front(), device);
  return static_cast<SetPart>(place.file->row(place.position).part);
}

std::vector<std::uint32_t> Set::devices_of(SetPart wanted) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t device = 0; device < devices(); ++device)
    if (part(device) == wanted) found.push_back(device);
  return found;
}

Recording Set::recording(std::string_view run, std::uint32_t device,
                         const std::vector<std::string>& variables) const {
  const internal::OpenSet::Place place = content().place_of(run, device);
  return place.file->recording(place.position, variables);
}

Recording Set::slow_recording(std::string_view run,
                              std::uint32_t device) const {
  const internal::OpenSet::Place place = content().place_of(run, device);
  return place.file->slow_recording(place.position);
}

std::vector<DrawnParameter> Set::drawn_parameters(std::string_view run,
                                                  std::uint32_t device) const {
  const internal::OpenSet::Place place = content().place_of(run, device);
  const std::vector<internal::DeviceVariable>& about =
      place.file->head().parameters;
  const std::vector<double>& values =
      place.file->row(place.position).parameters;
  std::vector<DrawnParameter> drawn;
  for (std::size_t i = 0; i < about.size(); ++i)
    drawn.push_back(
        {about[i].name, about[i].units, about[i].long_name, values[i]});
  return drawn;
}

std::vector<SetDefect> Set::verify(const Progress& progress) const {
  std::vector<SetDefect> defects;
  for (const internal::FileDefect& defect : internal::set_defects(
           content().directory, content().manifest,
           [&](std::uint64_t done, std::uint64_t total) {
             internal::report(progress, static_cast<double>(done) /
                                            static_cast<double>(total));
           }))
    defects.push_back({defect.file, defect.what});
  return defects;
}

}  // namespace beamgyro
