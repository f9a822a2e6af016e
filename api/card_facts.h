// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard.h"
#include "include/beamgyro/card.h"

namespace beamgyro::internal {

inline constexpr const char* kCroissantName = "croissant.json";
inline constexpr const char* kReadmeName = "README.md";

/// A file of a set, as a card lists it.
struct CardFile {
  std::string name;  // relative to the set
  std::uint64_t bytes = 0;
  std::string sha256, format, description;
};

/// A number that was drawn for each device.
struct CardParameter {
  std::string name;  // with the run before it, where runs differ in it
  DeviceVariable about;
  std::vector<std::optional<double>> values;  // of each device
};

/// Smallest and largest value.
struct CardRange {
  double lowest, highest;
};

/// One run of the devices. The ranges are of powered samples of the first few
/// devices.
struct CardRun {
  ShardHead head;
  std::size_t looked_at = 0;                        // devices
  std::optional<CardRange> temperature, true_rate;  // [degC], [deg/s]
};

struct CardFacts {
  ManifestHead head;
  std::string name, description;  // of the campaign
  std::vector<CardFile> files;
  std::vector<std::string> parts;         // of each device
  std::vector<std::string> failures;      // of each device; empty: none
  std::vector<CardParameter> parameters;  // empty for very many devices
  std::vector<CardRun> runs;
  std::vector<std::string> cautions;
};

/// Sets of more devices have no table of them in their card.
inline constexpr std::uint32_t kMostListedDevices = 20000;

/// Reads what a card says from a whole set. Throws as card_of().
CardFacts card_facts(const Set& set, const Progress& progress);

/// Returns the text of croissant.json; `readme` is that of README.md.
std::string croissant_text(const CardFacts& facts,
                           const SetCardOptions& options,
                           const std::string& readme);
/// Returns the text of README.md.
std::string readme_text(const CardFacts& facts, const SetCardOptions& options);

}  // namespace beamgyro::internal
