// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "config/document.h"
#include "dataset/set/source_copies.h"
#include "sim/device/device.h"
#include "sim/scenario/scenario.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro::internal {

/// The files that a campaign names, in their places or as the copies of a set.
/// Device and scenarios are read again for each value that a draw may take, so
/// that small files could ask for hours: together they are bounded. Every error
/// is a std::invalid_argument that names file, line and key.
class CampaignFiles {
 public:
  /// Names are relative to the folder of `campaign`. With `copies` no file is
  /// read but those.
  CampaignFiles(const ConfigDocument& campaign,
                std::span<const SourceText> copies);

  /// Returns the document that `table` names, the same for the same name.
  const ConfigDocument& named(const ConfigTable& table, const char* key);

  /// Reads `document`, one that named() returned or such with overrides, and
  /// counts its bytes and those of its profiles. `table` of the campaign is
  /// named when it is too much.
  DeviceParameters device(const ConfigDocument& document,
                          const ConfigTable& table);
  ScenarioPlan scenario(const ConfigDocument& document,
                        const ConfigTable& table);

  /// The campaign and what was read, in the order of reading.
  const std::vector<SourceText>& sources() const { return sources_; }
  const ProfileTables& profiles() const { return profiles_; }

 private:
  void add_profiles(const ConfigDocument& document);
  void add(const SourceText& source);
  void count(std::size_t bytes, const ConfigTable& table);

  std::filesystem::path folder_;
  std::span<const SourceText> copies_;  // none: files are read where they are
  std::map<std::string, ConfigDocument> documents_;
  std::vector<SourceText> sources_;
  ProfileTables profiles_;
  std::size_t bytes_ = 0;  // of files, for every time that they are read
};

}  // namespace beamgyro::internal
