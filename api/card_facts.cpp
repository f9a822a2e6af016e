// SPDX-License-Identifier: MIT
#include "api/card_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "api/reported_progress.h"
#include "api/set_defects.h"
#include "config/document.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/set_writer.h"
#include "dataset/set/shard/shard_reader.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLookedAt = 20;  // devices whose ranges are told

CardFile set_file(const fs::path& directory, const std::string& name,
                  std::string format, std::string description) {
  const std::string bytes = read_set_file(directory, name);
  return {name, bytes.size(), sha256(bytes), std::move(format),
          std::move(description)};
}

std::string format_of_source(const std::string& name) {
  return name.ends_with(".csv") ? "text/csv" : "application/toml";
}

std::vector<CardFile> files_of(const fs::path& directory,
                               const Manifest& manifest) {
  std::vector<CardFile> files = {
      set_file(directory, kManifestName, "application/jsonl",
               "What belongs to the set: files, checksums, devices that failed "
               "and why."),
      set_file(directory, kHeadCopyName, "application/jsonl",
               "A copy of the first line of the manifest.")};
  const std::vector<std::string>& runs = manifest.head->runs;
  for (const ManifestEntry& entry : manifest.entries)
    files.push_back(
        {entry.file, entry.bytes, entry.sha256, "application/x-hdf5",
         fmt::format("Run {} of devices {} to {}, netCDF-4.",
                     runs[entry.index % runs.size()], entry.first_device,
                     entry.first_device + entry.devices - 1)});
  for (const ManifestView& view : manifest.views)
    files.push_back({view.file, view.bytes, view.sha256, "application/x-hdf5",
                     "All devices of a run as one dataset; its values are in "
                     "the files beside it."});
  for (const SourceEntry& source : manifest.head->sources)
    files.push_back(set_file(
        directory, source.file, format_of_source(source.file),
        "A file that the generation read; the set can be made again from it."));
  return files;
}

// Name and description in the campaign file of the set.
void read_campaign(const fs::path& directory, CardFacts& facts) {
  const auto source = std::ranges::find(
      facts.head.sources, facts.head.campaign_sha256, &SourceEntry::sha256);
  if (source == facts.head.sources.end()) return;
  const ConfigDocument document = ConfigDocument::parse(
      read_set_file(directory, source->file), source->file);
  for (const auto& [key, text] :
       {std::pair{"name", &facts.name}, {"description", &facts.description}}) {
    const ConfigNode* node = document.value(key);
    if (node != nullptr && node->kind == ConfigNode::Kind::kText)
      *text = node->text;
  }
}

void widen(std::optional<CardRange>& range, double value) {
  if (!range) range = {value, value};
  range->lowest = std::min(range->lowest, value);
  range->highest = std::max(range->highest, value);
}

void look_at(const Recording& recording, CardRun& run) {
  for (const auto& [name, range] : {std::pair{"temperature", &run.temperature},
                                    {"true_rate", &run.true_rate}}) {
    const Column* column = find_column(recording, name);
    if (column == nullptr) continue;
    for (std::size_t k = 0; k < recording.time.size(); ++k)
      if ((recording.status[k] & kUnpowered) == 0)
        widen(*range, column->values[k]);
  }
  ++run.looked_at;
}

CardRun run_of(const Set& set, const Manifest& manifest, std::size_t number,
               const std::vector<std::string>& failures) {
  const std::string& name = manifest.head->runs[number];
  const auto first =
      std::ranges::find_if(manifest.entries, [&](const ManifestEntry& entry) {
        return entry.index % manifest.head->runs.size() == number;
      });
  const ShardFile file(set.directory() / first->file,
                       open_listed(set.directory(), *first));
  CardRun run{file.head(), 0, {}, {}};
  const std::uint32_t count = std::min(set.devices(), kLookedAt);
  for (std::uint32_t device = 0; device < count; ++device)
    if (failures[device].empty()) look_at(set.recording(name, device), run);
  return run;
}

// A number that has one value for a device in all runs is listed once.
std::vector<CardParameter> parameters_of(const Set& set,
                                         const std::vector<CardRun>& runs) {
  std::map<std::string, std::vector<CardParameter>> by_name;
  std::vector<std::string> order;
  for (const CardRun& run : runs) {
    for (const DeviceVariable& about : run.head.parameters) {
      if (!by_name.contains(about.name)) order.push_back(about.name);
      by_name[about.name].push_back(
          {run.head.run + "/" + about.name, about,
           std::vector<std::optional<double>>(set.devices())});
    }
    for (std::uint32_t device = 0; device < set.devices(); ++device)
      for (const DrawnParameter& drawn :
           set.drawn_parameters(run.head.run, device))
        by_name[drawn.name].back().values[device] = drawn.value;
  }
  std::vector<CardParameter> all;
  for (const std::string& name : order) {
    std::vector<CardParameter>& found = by_name[name];
    const bool is_one = found.size() == runs.size() &&
                        std::ranges::all_of(found, [&](const auto& one) {
                          return one.values == found.front().values;
                        });
    if (is_one) {
      found.resize(1);
      found.front().name = name;
    }
    std::ranges::move(found, std::back_inserter(all));
  }
  return all;
}

void require_whole(const Set& set, const Manifest& manifest,
                   const Progress& progress) {
  const std::vector<FileDefect> defects = set_defects(
      set.directory(), manifest, [&](std::uint64_t done, std::uint64_t total) {
        report(progress,
               static_cast<double>(done) / static_cast<double>(total));
      });
  if (!defects.empty())
    throw std::invalid_argument(fmt::format(
        "{}: {}: {}; expected a whole set, as a repair makes of this one",
        set.directory().string(), defects.front().file, defects.front().what));
}

}  // namespace

CardFacts card_facts(const Set& set, const Progress& progress) {
  const fs::path directory = set.directory();
  const Manifest manifest = finished_manifest(directory);
  require_whole(set, manifest, progress);
  CardFacts facts;
  facts.head = *manifest.head;
  facts.name = fs::path(facts.head.campaign).stem().string();
  read_campaign(directory, facts);
  facts.files = files_of(directory, manifest);
  facts.failures.resize(set.devices());
  for (const SetFailure& failure : set.failures())
    facts.failures[failure.device] += fmt::format(
        "{}{}: {}", facts.failures[failure.device].empty() ? "" : "; ",
        failure.run, failure.reason);
  for (std::uint32_t device = 0; device < set.devices(); ++device)
    facts.parts.emplace_back(part_name(set.part(device)));
  for (std::size_t run = 0; run < facts.head.runs.size(); ++run)
    facts.runs.push_back(run_of(set, manifest, run, facts.failures));
  if (set.devices() <= kMostListedDevices)
    facts.parameters = parameters_of(set, facts.runs);
  facts.cautions = caution_texts(set_contents(directory).state);
  return facts;
}

}  // namespace beamgyro::internal
