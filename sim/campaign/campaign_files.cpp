// SPDX-License-Identifier: MIT
#include "sim/campaign/campaign_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "config/file_error.h"
#include "dataset/files/text_file.h"
#include "sim/device/device_file.h"

namespace beamgyro::internal {

CampaignFiles::CampaignFiles(const ConfigDocument& campaign,
                             std::span<const SourceText> copies)
    : folder_(campaign.path().parent_path()), copies_(copies) {
  add({campaign.path(), campaign.text()});
}

const ConfigDocument& CampaignFiles::named(const ConfigTable& table,
                                           const char* key) {
  const std::string name = table.text(key);
  const auto known = documents_.find(name);
  if (known != documents_.end()) return known->second;
  const std::filesystem::path path = folder_ / name;
  const auto read = [&] {
    if (!copies_.empty()) {
      const SourceText& copy = copy_of(path, copies_);
      return ConfigDocument::parse(copy.text, copy.path.string());
    }
    if (!std::filesystem::is_regular_file(status_of(path)))
      table.fail(key, fmt::format("there is no file {}; expected one, named "
                                  "relative to the campaign",
                                  path.string()));
    return ConfigDocument::read(path);
  };
  const ConfigDocument& document =
      documents_.emplace(name, read()).first->second;
  add({document.path(), document.text()});
  return document;
}

DeviceParameters CampaignFiles::device(const ConfigDocument& document,
                                       const ConfigTable& table) {
  count(document.text().size(), table);
  return read_device(document);
}

// An error in a profile names its place in the scenario, unless there are only
// copies to read.
ScenarioPlan CampaignFiles::scenario(const ConfigDocument& document,
                                     const ConfigTable& table) {
  count(document.text().size(), table);
  if (!copies_.empty()) add_profiles(document);
  ScenarioPlan scenario = read_scenario(document, &profiles_);
  if (copies_.empty()) add_profiles(document);
  for (const std::filesystem::path& file : profile_files(document)) {
    const CsvTable& profile = profiles_.at(file.lexically_normal());
    count(profile.columns.size() * profile.columns.front().size() *
              sizeof(double),
          table);
  }
  return scenario;
}

void CampaignFiles::add_profiles(const ConfigDocument& document) {
  for (const std::filesystem::path& file : profile_files(document)) {
    if (profiles_.contains(file.lexically_normal())) continue;
    const SourceText source = copies_.empty()
                                  ? SourceText{file, read_text_file(file)}
                                  : copy_of(file, copies_);
    profiles_.emplace(file.lexically_normal(),
                      parse_csv(source.text, file.filename()));
    add(source);
  }
}

void CampaignFiles::add(const SourceText& source) {
  const std::filesystem::path place = source.path.lexically_normal();
  if (std::ranges::none_of(sources_, [&](const SourceText& other) {
        return other.path.lexically_normal() == place;
      }))
    sources_.push_back(source);
}

void CampaignFiles::count(std::size_t bytes, const ConfigTable& table) {
  constexpr std::size_t kMost = std::size_t{32} << 20;
  constexpr std::size_t kEach = 1024;  // to read a file costs this at least
  bytes_ += std::max(bytes, kEach);
  if (bytes_ <= kMost) return;
  throw std::invalid_argument(fmt::format(
      "{}: device and scenarios together have more than {} MiB, counted once "
      "for each run and each value that may be drawn; expected smaller files, "
      "fewer runs or fewer values",
      table.position(""), kMost >> 20));
}

}  // namespace beamgyro::internal
