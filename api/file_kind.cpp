// SPDX-License-Identifier: MIT
#include "api/file_kind.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "config/document.h"
#include "config/file_error.h"
#include "dataset/files/open_file.h"
#include "dataset/log/recording_csv.h"
#include "dataset/netcdf/curves_file.h"
#include "dataset/netcdf/recording_reader.h"
#include "dataset/set/manifest.h"
#include "dataset/set/shard/shard.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

struct KnownKind {
  FileKind kind;
  const char *name, *taken_by;
};
constexpr KnownKind kKnownKinds[] = {
    {FileKind::kDevice, "a device file", "beamgyro characterise"},
    {FileKind::kScenario, "a scenario", "beamgyro run"},
    {FileKind::kCampaign, "a campaign", "beamgyro generate"},
    {FileKind::kModel, "a model file", "beamgyro train --model"},
    {FileKind::kQualification, "a qualification",
     "beamgyro validate --qualification"},
    {FileKind::kSpecification, "a specification", "beamgyro validate --spec"},
    {FileKind::kLogMap, "a log map", "beamgyro import --map"},
    {FileKind::kRecording, "a recording",
     "beamgyro info, allan, train, compensate or validate"},
    {FileKind::kSetFile, "a file of a set", "beamgyro info"},
    {FileKind::kSet, "the directory of a set",
     "beamgyro info, verify, train or validate"},
    {FileKind::kCompensator, "a compensator",
     "beamgyro compensate, validate or export"},
    {FileKind::kRecordingTable, "a recording as CSV",
     "beamgyro info, allan, train, compensate or validate"},
    {FileKind::kCharacteristic, "a table that characterise wrote",
     "beamgyro plot"},
    {FileKind::kCurves, "the curves of a population", "beamgyro plot"},
    {FileKind::kResult, "a result that --json wrote", "beamgyro plot"},
    {FileKind::kProfile, "a profile over time",
     "the key \"file\" of a scenario"},
    {FileKind::kLog, "a log", "beamgyro import"},
};

const KnownKind& known(FileKind kind) {
  return *std::ranges::find(kKnownKinds, kind, &KnownKind::kind);
}

/// Returns the first bytes of a file, enough to tell its kind.
std::string head_of(const fs::path& path) {
  std::array<std::byte, 65536> bytes{};
  const std::size_t count = OpenFile(path, O_RDONLY).read(bytes);
  return {reinterpret_cast<const char*>(bytes.data()), count};
}

/// Returns the kinds that a TOML file may be, by the keys that only they have.
std::vector<FileKind> kinds_of_toml(const fs::path& path) {
  const ConfigDocument document = ConfigDocument::read(path);
  const auto has = [&](std::initializer_list<std::string_view> keys) {
    return std::ranges::any_of(keys, [&](std::string_view key) {
      return document.value(key) != nullptr;
    });
  };
  std::vector<FileKind> kinds;
  if (has({"beam", "patches", "bond"})) kinds.push_back(FileKind::kDevice);
  const bool has_devices = has({"device", "devices", "tolerances"});
  if (has({"run", "training"}) && !has_devices)
    kinds.push_back(FileKind::kQualification);
  if (has({"limits", "limits_relative_to"}))
    kinds.push_back(FileKind::kSpecification);
  if (has({"devices", "tolerances"}) || (has({"run"}) && has_devices))
    kinds.push_back(FileKind::kCampaign);
  if (has({"duration_s", "fidelity", "ambient"}))
    kinds.push_back(FileKind::kScenario);
  if (has({"kind"})) kinds.push_back(FileKind::kModel);
  if (has({"time", "gyro"})) kinds.push_back(FileKind::kLogMap);
  return kinds;
}

std::vector<FileKind> kinds_of_json(std::string_view head) {
  const auto holds = [&](std::string_view word) {
    return head.find(word) != head.npos;
  };
  if (holds("\"beamgyro-compensator\"")) return {FileKind::kCompensator};
  // Of validate, allan, plan and sensitivity.
  if (std::ranges::any_of(std::array{"\"beamgyro-validation\"", "\"clusters\"",
                                     "\"trade_off\"", "\"indices\""},
                          holds))
    return {FileKind::kResult};
  return {};
}

std::vector<FileKind> kinds_of_text(const fs::path& path,
                                    std::string_view head) {
  const std::string_view line = head.substr(0, head.find_first_of("\r\n"));
  if (line.starts_with("temperature_degC,bias_deg_per_s"))
    return {FileKind::kCharacteristic};
  if (line.starts_with("temperature_degC,device_")) return {FileKind::kCurves};
  if (line.starts_with("time_s,")) return {FileKind::kProfile};
  if (is_recording_csv(line))
    return {FileKind::kRecordingTable, FileKind::kRecording};
  if (head.starts_with('{')) return kinds_of_json(head);
  try {
    return kinds_of_toml(path);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::vector<FileKind> found_kinds(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    return fs::exists(path / kManifestName, ignored)
               ? std::vector{FileKind::kSet}
               : std::vector<FileKind>{};
  if (!fs::is_regular_file(path, ignored)) return {};
  const std::string head = head_of(path);
  if (!head.starts_with("\x89HDF")) return kinds_of_text(path, head);
  if (head.find(kRecordingFiletype) != head.npos) return {FileKind::kRecording};
  if (head.find(kCurvesFiletype) != head.npos) return {FileKind::kCurves};
  if (head.find(kSetFiletype) != head.npos) return {FileKind::kSetFile};
  return {};
}

}  // namespace

std::vector<FileKind> kinds_of(const fs::path& path) {
  try {
    return found_kinds(path);
  } catch (const std::system_error&) {
    return {};  // whoever reads it says why it cannot
  }
}

std::string_view kind_name(FileKind kind) { return known(kind).name; }

bool is_of_kind(const fs::path& path, FileKind kind) {
  return std::ranges::count(kinds_of(path), kind) != 0;
}

bool is_set(const std::vector<fs::path>& paths) {
  for (const fs::path& path : paths)
    if (fs::is_directory(status_of(path))) {
      if (paths.size() == 1) return true;
      throw std::invalid_argument(path.string() +
                                  ": a directory among recordings; expected "
                                  "recordings, or the directory of one set");
    }
  return false;
}

void require_kind(const fs::path& path, const ExpectedKinds& expected) {
  const std::vector<FileKind> kinds = kinds_of(path);
  const auto is_among = [&](const std::vector<FileKind>& taken) {
    return std::ranges::find_first_of(kinds, taken) != kinds.end();
  };
  if (kinds.empty() || is_among(expected.kinds) || is_among(expected.also))
    return;
  const KnownKind& found = known(kinds.front());
  std::vector<std::string_view> names;
  for (const FileKind kind : expected.kinds) names.push_back(kind_name(kind));
  std::string message = fmt::format("{}: is {}; expected {}", path.string(),
                                    found.name, fmt::join(names, " or "));
  if (*found.taken_by != '\0')
    message += fmt::format("; {} is for {}", found.taken_by, found.name);
  throw std::invalid_argument(message);
}

}  // namespace beamgyro::internal
