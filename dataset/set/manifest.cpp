// SPDX-License-Identifier: MIT
#include "dataset/set/manifest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <system_error>

#include "config/file_error.h"
#include "config/option_message.h"
#include "dataset/files/json_node.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"

namespace beamgyro::internal {

// Found by the JSON library by their names.
static void to_json(nlohmann::ordered_json& json, const SourceEntry& source) {
  json = {{"file", source.file}, {"sha256", source.sha256}};
}
static void to_json(nlohmann::ordered_json& json,
                    const DeviceFailure& failure) {
  json = {{"device", failure.device}, {"reason", failure.reason}};
}

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFiletype = "beamgyro-manifest";
constexpr std::uint64_t kFormatVersion = 1;
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

/// A manifest of a program that is newer than this one.
struct UnknownFormat : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The object of a line without its end. Throws std::invalid_argument for one
/// that is not whole.
Json object_of(std::string_view line, const std::string& place) {
  const std::size_t tail = kCheck.size() + kCheckDigits + 2;
  const std::string_view body =
      line.substr(0, line.size() - std::min(tail, line.size()));
  if (body.empty() ||
      line.substr(body.size()) != std::string(kCheck) + check_of(body) + "\"}")
    throw std::invalid_argument(place + ": the line is damaged");
  return parse_json(std::string(body) + "}", place);
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

void require(const JsonNode& line, bool is_right, const std::string& key) {
  if (!is_right) line.at(key).fail("is a name no set has");
}

/// Returns whether this is a name below source/ that leads nowhere else.
bool is_source_name(const std::string& text) {
  const std::filesystem::path name = text;
  return text.starts_with("source/") &&
         text == name.lexically_normal().string() && name.has_filename() &&
         text.find('\0') == std::string::npos &&
         std::ranges::find(name, "..") == name.end();
}

/// Returns whether the part before `ending` is the name of a run.
bool is_file_of_run(std::string_view name, std::string_view ending) {
  return name.ends_with(ending) &&
         is_run_name(name.substr(0, name.size() - ending.size()));
}

/// As expected_entry() makes them.
bool is_shard_name(std::string_view name) {
  const std::size_t mark = std::min(name.rfind('_'), name.size());
  const std::string_view rest = name.substr(mark);
  constexpr std::string_view kEnding = ".h5";
  return rest.size() >= 6 + kEnding.size() && rest.ends_with(kEnding) &&
         rest.find_first_not_of("0123456789", 1) ==
             rest.size() - kEnding.size() &&
         is_run_name(name.substr(0, mark));
}

/// Ranges of devices, each with a file for every run.
std::uint64_t ranges_of(const ManifestHead& head) {
  return head.devices / head.devices_per_file +
         (head.devices % head.devices_per_file != 0 ? 1 : 0);
}

ManifestHead head_of(const JsonNode& line) {
  ManifestHead head;
  head.campaign = line.at("campaign").text();
  head.campaign_sha256 = line.at("campaign_sha256").text();
  head.program_version = line.at("beamgyro_version").text();
  head.git_revision = line.at("git_revision").text();
  head.seed = line.at("seed").unsigned_integer();
  head.devices = line.at("devices").small_integer();
  head.devices_per_file = line.at("devices_per_file").small_integer();
  head.runs = line.at("runs").texts();
  for (const JsonNode& source : line.at("sources").elements())
    head.sources.push_back(
        {source.at("file").text(), source.at("sha256").text()});
  require(line, std::ranges::all_of(head.runs, is_run_name), "runs");
  for (const SourceEntry& source : head.sources)
    require(line, is_source_name(source.file), "sources");
  if (head.devices == 0 || head.devices_per_file == 0 || head.runs.empty() ||
      head.sources.empty() ||
      ranges_of(head) * head.runs.size() >
          std::numeric_limits<std::uint32_t>::max())
    line.fail("describes no set");
  return head;
}

Json json_of(const ManifestEntry& entry) {
  Json json = {{"index", entry.index},
               {"file", entry.file},
               {"bytes", entry.bytes},
               {"sha256", entry.sha256},
               {"first_device", entry.first_device},
               {"devices", entry.devices},
               {"failures", entry.failures}};
  if (const CautionCounts& count = entry.cautions; count != CautionCounts{})
    json["cautions"] = {{"unpowered", count.unpowered},
                        {"not_locked", count.not_locked},
                        {"saturated", count.saturated}};
  return json;
}

ManifestEntry entry_of(const JsonNode& line) {
  ManifestEntry entry;
  entry.index = line.at("index").small_integer();
  entry.file = line.at("file").text();
  entry.bytes = line.at("bytes").unsigned_integer();
  entry.sha256 = line.at("sha256").text();
  entry.first_device = line.at("first_device").small_integer();
  entry.devices = line.at("devices").small_integer();
  for (const JsonNode& failure : line.at("failures").elements())
    entry.failures.push_back(
        {failure.at("device").small_integer(), failure.at("reason").text()});
  if (line.has("cautions")) {
    const JsonNode cautions = line.at("cautions");
    entry.cautions = {cautions.at("unpowered").small_integer(),
                      cautions.at("not_locked").small_integer(),
                      cautions.at("saturated").small_integer()};
  }
  require(line, is_shard_name(entry.file), "file");
  return entry;
}

Json json_of(const ManifestView& view) {
  return {{"view", view.file}, {"bytes", view.bytes}, {"sha256", view.sha256}};
}

ManifestView view_of(const JsonNode& line) {
  ManifestView view{line.at("view").text(), line.at("bytes").unsigned_integer(),
                    line.at("sha256").text()};
  require(line, is_file_of_run(view.file, ".nc"), "view");
  return view;
}

/// State of reading a manifest line by line.
struct Reading {
  Manifest manifest;
  std::map<std::uint32_t, ManifestEntry> entries;

  /// `before`: all bytes before the line.
  void take(const JsonNode& line, std::string_view before) {
    if (line.has("filetype")) {
      if (line.at("filetype").text() != kFiletype)
        line.at("filetype").fail("is no manifest's");
      const std::uint64_t version =
          line.at("format_version").unsigned_integer();
      if (version != kFormatVersion)
        throw UnknownFormat(
            fmt::format("format_version {} is not known; this program reads {}",
                        version, kFormatVersion));
      manifest.head = head_of(line);
    } else if (line.has("index")) {
      ManifestEntry entry = entry_of(line);
      entries.insert_or_assign(entry.index, entry);
    } else if (line.has("view")) {
      manifest.views.push_back(view_of(line));
    } else {
      manifest.is_finished = true;
      const bool is_same = line.at("sha256_before").text() == sha256(before);
      if (!is_same && manifest.damaged_lines.empty())
        line.at("sha256_before").fail("is that of other lines");
    }
  }
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

bool is_run_name(std::string_view text) {
  constexpr std::size_t kMost = 200;
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  return !text.empty() && text.size() <= kMost &&
         kLetters.find(text.front()) != kLetters.npos &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") ==
             text.npos;
}

std::uint32_t file_count(const ManifestHead& head) {
  return static_cast<std::uint32_t>(ranges_of(head) * head.runs.size());
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

bool is_file_of(const ManifestHead& head, const std::string& name) {
  const std::uint64_t runs = head.runs.size();
  const std::size_t mark = name.rfind('_');
  for (std::uint64_t run = 0; mark != name.npos && run < runs; ++run) {
    if (name.substr(0, mark) != head.runs[run]) continue;
    std::uint32_t range = 0;
    std::from_chars(name.data() + mark + 1, name.data() + name.size(), range);
    const std::uint64_t index = range * runs + run;
    return index < file_count(head) &&
           expected_entry(head, static_cast<std::uint32_t>(index)).file == name;
  }
  return false;
}

std::string view_name(std::string_view run) {
  return fmt::format("{}.nc", run);
}

std::string part_name(std::uint32_t task, std::uint32_t tasks) {
  return fmt::format("manifest.{}-of-{}.jsonl", task, tasks);
}

Manifest read_manifest(const std::filesystem::path& directory,
                       const std::filesystem::path& name) {
  const std::string text = read_set_file(directory, name);
  Reading reading;
  std::vector<std::size_t>& damaged = reading.manifest.damaged_lines;
  std::size_t number = 0;
  for (std::size_t place = 0; place < text.size();) {
    const std::size_t end = std::min(text.find('\n', place), text.size());
    const std::string_view all(text);
    reading.manifest.is_finished = false;
    ++number;
    const std::string line =
        fmt::format("{}:{}", (directory / name).string(), number);
    try {
      const Json json = object_of(all.substr(place, end - place), line);
      reading.take(JsonNode(json, line), all.substr(0, place));
    } catch (const UnknownFormat& error) {
      throw std::invalid_argument(fmt::format("{}: {}", line, error.what()));
    } catch (const std::invalid_argument&) {
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

Manifest finished_manifest(const std::filesystem::path& directory) {
  if (!find_in_set(directory, kManifestName))
    throw std::invalid_argument(fmt::format(
        "{}: holds no set, or none that is finished; expected a directory that "
        "generate made",
        directory.string()));
  Manifest manifest = read_manifest(directory, kManifestName);
  if (!manifest.head || !manifest.is_finished)
    throw option_error(
        "{}: the set is not finished; generate with {} finishes it",
        directory.string(), NamedOption{"resume"});
  if (!manifest.damaged_lines.empty() ||
      manifest.entries.size() != file_count(*manifest.head))
    throw std::invalid_argument(
        fmt::format("{}: the manifest is damaged; run beamgyro verify",
                    directory.string()));
  return manifest;
}

void start_manifest(const std::filesystem::path& directory,
                    const std::filesystem::path& name, const ManifestHead& head,
                    const std::vector<ManifestEntry>& entries) {
  std::string text = line_of(json_of(head));
  for (const ManifestEntry& entry : entries) text += line_of(json_of(entry));
  publish_file(directory, name, bytes_of(text));
}

OpenFile open_listed(const std::filesystem::path& directory,
                     const ManifestEntry& entry) {
  OpenFile file = open_set_file(directory, entry.file, O_RDONLY);
  try {
    if (file.size() == entry.bytes && sha256_of_rest(file) == entry.sha256)
      return file;
  } catch (const std::system_error& error) {
    throw_file_error(directory / entry.file, "cannot read", error.code());
  }
  throw std::invalid_argument(
      fmt::format("{}: holds other bytes than the manifest says; run beamgyro "
                  "verify",
                  (directory / entry.file).string()));
}

void append_entry(const std::filesystem::path& directory,
                  const std::filesystem::path& name,
                  const ManifestEntry& entry) {
  const std::filesystem::path path = directory / name;
  OpenFile file = open_set_file(directory, name, O_RDWR | O_APPEND);
  try {
    struct stat facts {};
    if (fstat(file.descriptor(), &facts) != 0)
      throw std::system_error(errno, std::generic_category());
    if (facts.st_nlink > 1)
      throw std::runtime_error(fmt::format(
          "{}: has another name, too, and may be somebody else's file; "
          "expected a manifest of its own, which resuming the generation makes",
          path.string()));
    std::string line = line_of(json_of(entry));
    // A line that a dead process cut short must not swallow this one.
    char last = '\n';
    if (facts.st_size > 0)
      file.read_at(static_cast<std::uint64_t>(facts.st_size - 1),
                   std::as_writable_bytes(std::span(&last, 1)));
    if (last != '\n') line.insert(0, 1, '\n');
    file.write(bytes_of(line));
    file.sync();
    file.close();
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("{}: cannot write: {}", path.string(),
                                error.code().message()),
                    error.code());
  }
}

void write_manifest(const std::filesystem::path& directory,
                    const std::filesystem::path& name,
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
  publish_file(directory, name, bytes_of(text));
}

}  // namespace beamgyro::internal
