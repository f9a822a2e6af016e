// SPDX-License-Identifier: MIT
#include "dataset/set/manifest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <system_error>

#include "dataset/open_file.h"
#include "dataset/set/publish.h"
#include "dataset/sha256.h"
#include "dataset/text_file.h"

namespace beamgyro {

// Found by the JSON library by their names.
static void to_json(nlohmann::ordered_json& json, const SourceEntry& source) {
  json = {{"file", source.file}, {"sha256", source.sha256}};
}
static void from_json(const nlohmann::ordered_json& json, SourceEntry& source) {
  json.at("file").get_to(source.file);
  json.at("sha256").get_to(source.sha256);
}
static void to_json(nlohmann::ordered_json& json,
                    const DeviceFailure& failure) {
  json = {{"device", failure.device}, {"reason", failure.reason}};
}
static void from_json(const nlohmann::ordered_json& json,
                      DeviceFailure& failure) {
  json.at("device").get_to(failure.device);
  json.at("reason").get_to(failure.reason);
}

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFiletype = "beamgyro-manifest";
constexpr int kFormatVersion = 1;
constexpr std::string_view kCheck = R"(,"check":")";
constexpr std::size_t kCheckDigits = 16;

std::string check_of(std::string_view body) {
  return sha256(body).substr(0, kCheckDigits);
}

/// {...,"check":"..."}: the checksum is that of all before it.
std::string line_of(const Json& json) {
  std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  line.pop_back();
  return line + std::string(kCheck) + check_of(line) + "\"}\n";
}

/// The object of a line without its end, if it is whole.
std::optional<Json> object_of(std::string_view line) {
  const std::size_t tail = kCheck.size() + kCheckDigits + 2;
  if (line.size() <= tail) return {};
  const std::string_view body = line.substr(0, line.size() - tail);
  if (line.substr(body.size()) != std::string(kCheck) + check_of(body) + "\"}")
    return {};
  Json json = Json::parse(std::string(body) + "}", nullptr, false);
  if (!json.is_object()) return {};
  return json;
}

Json json_of(const ManifestHead& head) {
  return {{"filetype", kFiletype},
          {"format_version", kFormatVersion},
          {"campaign", head.campaign},
          {"campaign_sha256", head.campaign_sha256},
          {"beamgyro_version", head.program_version},
          {"git_revision", head.git_revision},
          {"seed", head.seed},
          {"devices", head.devices},
          {"devices_per_file", head.devices_per_file},
          {"runs", head.runs},
          {"sources", head.sources}};
}

ManifestHead head_of(const Json& json) {
  ManifestHead head;
  json.at("campaign").get_to(head.campaign);
  json.at("campaign_sha256").get_to(head.campaign_sha256);
  json.at("beamgyro_version").get_to(head.program_version);
  json.at("git_revision").get_to(head.git_revision);
  json.at("seed").get_to(head.seed);
  json.at("devices").get_to(head.devices);
  json.at("devices_per_file").get_to(head.devices_per_file);
  json.at("runs").get_to(head.runs);
  json.at("sources").get_to(head.sources);
  if (head.devices_per_file == 0) throw std::out_of_range("devices_per_file");
  return head;
}

Json json_of(const ManifestEntry& entry) {
  return {{"index", entry.index},
          {"file", entry.file},
          {"bytes", entry.bytes},
          {"sha256", entry.sha256},
          {"first_device", entry.first_device},
          {"devices", entry.devices},
          {"failures", entry.failures}};
}

ManifestEntry entry_of(const Json& json) {
  ManifestEntry entry;
  json.at("index").get_to(entry.index);
  json.at("file").get_to(entry.file);
  json.at("bytes").get_to(entry.bytes);
  json.at("sha256").get_to(entry.sha256);
  json.at("first_device").get_to(entry.first_device);
  json.at("devices").get_to(entry.devices);
  json.at("failures").get_to(entry.failures);
  return entry;
}

Json json_of(const ManifestView& view) {
  return {{"view", view.file}, {"bytes", view.bytes}, {"sha256", view.sha256}};
}

ManifestView view_of(const Json& json) {
  ManifestView view;
  json.at("view").get_to(view.file);
  json.at("bytes").get_to(view.bytes);
  json.at("sha256").get_to(view.sha256);
  return view;
}

/// What a manifest says so far.
struct Reading {
  Manifest manifest;
  std::map<std::uint32_t, ManifestEntry> entries;

  /// `before`: all bytes before the line.
  void take(const Json& json, std::string_view before) {
    if (json.contains("filetype")) {
      if (json.at("filetype") != kFiletype) throw std::out_of_range("filetype");
      if (json.at("format_version") != kFormatVersion)
        throw std::invalid_argument(
            fmt::format("format_version {} is not known; this program reads {}",
                        json.at("format_version").dump(), kFormatVersion));
      manifest.head = head_of(json);
    } else if (json.contains("index")) {
      ManifestEntry entry = entry_of(json);
      entries.insert_or_assign(entry.index, entry);
    } else if (json.contains("view")) {
      manifest.views.push_back(view_of(json));
    } else {
      manifest.is_finished = true;
      const bool is_same = json.at("sha256_before") == sha256(before);
      if (!is_same && manifest.damaged_lines.empty())
        throw std::out_of_range("sha256_before");
    }
  }
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

std::uint32_t file_count(const ManifestHead& head) {
  const std::uint32_t ranges =
      head.devices / head.devices_per_file +
      (head.devices % head.devices_per_file != 0 ? 1 : 0);
  return ranges * static_cast<std::uint32_t>(head.runs.size());
}

ManifestEntry expected_entry(const ManifestHead& head, std::uint32_t index) {
  const auto runs = static_cast<std::uint32_t>(head.runs.size());
  const std::uint32_t range = index / runs;
  ManifestEntry entry;
  entry.index = index;
  entry.file = fmt::format("{}_{:05}.h5", head.runs[index % runs], range);
  entry.first_device = range * head.devices_per_file;
  entry.devices =
      std::min(head.devices_per_file, head.devices - entry.first_device);
  return entry;
}

std::string view_name(std::string_view run) {
  return fmt::format("{}.nc", run);
}

std::string part_name(std::uint32_t task, std::uint32_t tasks) {
  return fmt::format("manifest.{}-of-{}.jsonl", task, tasks);
}

Manifest read_manifest(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  Reading reading;
  std::vector<std::size_t>& damaged = reading.manifest.damaged_lines;
  std::size_t number = 0;
  for (std::size_t place = 0; place < text.size();) {
    const std::size_t end = std::min(text.find('\n', place), text.size());
    const std::string_view all(text);
    reading.manifest.is_finished = false;
    ++number;
    const std::optional<Json> json = object_of(all.substr(place, end - place));
    try {
      if (!json) throw std::out_of_range("check");
      reading.take(*json, all.substr(0, place));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("{}:{}: {}", path.string(), number, error.what()));
    } catch (const std::exception&) {  // of the JSON library, too
      if (end < text.size()) damaged.push_back(number);
    }
    place = end + 1;
  }
  Manifest& manifest = reading.manifest;
  for (auto& [index, entry] : reading.entries)
    manifest.entries.push_back(std::move(entry));
  if (!text.empty() && text.back() != '\n') manifest.is_finished = false;
  return std::move(manifest);
}

void start_manifest(const std::filesystem::path& path,
                    const ManifestHead& head) {
  publish_file(path, bytes_of(line_of(json_of(head))));
}

void append_entry(const std::filesystem::path& path,
                  const ManifestEntry& entry) {
  try {
    OpenFile file(path, O_RDWR | O_APPEND);
    std::string line = line_of(json_of(entry));
    // A line that a dead process cut short must not swallow this one.
    char last = '\n';
    const off_t size = lseek(file.descriptor(), 0, SEEK_END);
    if (size > 0 && pread(file.descriptor(), &last, 1, size - 1) != 1)
      throw std::system_error(errno, std::generic_category());
    if (last != '\n') line.insert(0, 1, '\n');
    file.write(bytes_of(line));
    file.sync();
    file.close();
  } catch (const std::system_error& error) {
    throw std::runtime_error(fmt::format("{}: cannot write: {}", path.string(),
                                         error.code().message()));
  }
}

void write_manifest(const std::filesystem::path& path,
                    const Manifest& manifest) {
  const std::string head = line_of(json_of(manifest.head.value()));
  std::string text = head;
  std::vector<ManifestEntry> entries = manifest.entries;
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  for (const ManifestEntry& entry : entries) text += line_of(json_of(entry));
  std::vector<ManifestView> views = manifest.views;
  std::sort(views.begin(), views.end(),
            [](const auto& a, const auto& b) { return a.file < b.file; });
  for (const ManifestView& view : views) text += line_of(json_of(view));
  text += head;
  text += line_of({{"sha256_before", sha256(text)}});
  publish_file(path, bytes_of(text));
}

}  // namespace beamgyro
