// SPDX-License-Identifier: MIT
#include "compensation/compensator/training_runs_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <system_error>

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr long kLargestDevice = 4294967295;
constexpr std::size_t kMostDevices = 100000000;

/// 16 hexadecimal digits each.
std::string sketch_text(const MeasuredSketch& sketch) {
  std::string text;
  for (const std::uint64_t hash : sketch)
    fmt::format_to(std::back_inserter(text), "{:016x}", hash);
  return text;
}

MeasuredSketch read_sketch(const JsonNode& node) {
  constexpr std::size_t kHashDigits = 16;
  const std::string text = node.text();
  MeasuredSketch sketch;
  for (std::size_t k = 0; k + kHashDigits <= text.size(); k += kHashDigits) {
    const char* begin = text.data() + k;
    const auto [end, error] =
        std::from_chars(begin, begin + kHashDigits, sketch.emplace_back(), 16);
    if (error != std::errc() || end != begin + kHashDigits) break;
  }
  if (text.size() != kHashDigits * sketch.size() ||
      sketch_text(sketch) != text || !std::ranges::is_sorted(sketch))
    node.fail("must be hexadecimal numbers of 16 digits, in rising order");
  return sketch;
}

Json files_json(const std::vector<SourceFile>& files) {
  Json array = Json::array();
  for (const SourceFile& file : files) {
    array.push_back({{"name", file.name},
                     {"sha256", file.sha256},
                     {"measured_sha256", file.measured_sha256},
                     {"measured_sketch", sketch_text(file.sketch)}});
    if (file.seed) array.back()["seed"] = *file.seed;
  }
  return array;
}

/// [first, last] of each stretch of increasing numbers without a gap.
Json ranges_of(const std::vector<std::uint32_t>& numbers) {
  Json ranges = Json::array();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (k > 0 && numbers[k] == numbers[k - 1] + 1)
      ranges.back()[1] = numbers[k];
    else
      ranges.push_back({numbers[k], numbers[k]});
  }
  return ranges;
}

Json set_json(const std::optional<TrainingSet>& set) {
  if (!set) return {};
  return {{"name", set->name},
          {"manifest_sha256", set->manifest_sha256},
          {"devices", set->devices},
          {"files", set->files},
          {"campaign_sha256", set->campaign_sha256},
          {"seed", set->seed},
          {"runs", set->runs},
          {"device_ranges", ranges_of(set->device_numbers)}};
}

std::vector<SourceFile> read_files(const JsonNode& node) {
  std::vector<SourceFile> files;
  for (const JsonNode& file : node.elements()) {
    files.push_back({file.at("name").text(), file.at("sha256").text()});
    if (file.has("measured_sha256"))
      files.back().measured_sha256 = file.at("measured_sha256").text();
    if (file.has("measured_sketch"))
      files.back().sketch = read_sketch(file.at("measured_sketch"));
    if (file.has("seed"))
      files.back().seed = file.at("seed").unsigned_integer();
  }
  return files;
}

std::vector<std::uint32_t> read_ranges(const JsonNode& node) {
  std::vector<std::uint32_t> numbers;
  for (const JsonNode& range : node.elements()) {
    const std::vector<JsonNode> ends = range.elements();
    if (ends.size() != 2) range.fail("must be [first, last]");
    const long first = ends[0].integer(0, kLargestDevice);
    const long last = ends[1].integer(first, kLargestDevice);
    if (numbers.size() + static_cast<std::size_t>(last - first) >= kMostDevices)
      range.fail(fmt::format("more than {} devices", kMostDevices));
    for (long k = first; k <= last; ++k)
      numbers.push_back(static_cast<std::uint32_t>(k));
  }
  return numbers;
}

// The oldest files lack the key; later ones lack the list of devices.
std::optional<TrainingSet> read_set(const JsonNode& node,
                                    const std::string& key) {
  if (!node.has(key) || node.at(key).is_null()) return std::nullopt;
  const JsonNode set = node.at(key);
  TrainingSet part{
      set.at("name").text(), set.at("manifest_sha256").text(),
      static_cast<std::size_t>(set.at("devices").integer(0, kLargestDevice)),
      static_cast<std::size_t>(set.at("files").integer(0, kLargestDevice))};
  if (set.has("device_ranges")) {
    part.campaign_sha256 = set.at("campaign_sha256").text();
    part.seed = set.at("seed").unsigned_integer();
    part.runs = set.at("runs").texts();
    part.device_numbers = read_ranges(set.at("device_ranges"));
  }
  return part;
}

}  // namespace

void put_training_runs(const Provenance& provenance, Json& json) {
  json["files"] = files_json(provenance.training);
  json["held_out_files"] = files_json(provenance.held_out);
  json["set"] = set_json(provenance.training_set);
  json["held_out_set"] = set_json(provenance.held_out_set);
}

void read_training_runs(const JsonNode& node, Provenance& provenance) {
  provenance.training = read_files(node.at("files"));
  provenance.held_out = read_files(node.at("held_out_files"));
  provenance.training_set = read_set(node, "set");
  provenance.held_out_set = read_set(node, "held_out_set");
}

}  // namespace beamgyro::internal
