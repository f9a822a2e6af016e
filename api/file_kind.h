// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

enum class FileKind {
  kDevice,
  kScenario,
  kCampaign,
  kModel,
  kQualification,
  kSpecification,
  kLogMap,
  kRecording,
  kSetFile,
  kSet,
  kCompensator,
  kRecordingTable,  // a recording as CSV
  kCharacteristic,  // what characterise writes of a device
  kCurves,          // what it writes of a campaign
  kResult,          // what --json writes
  kProfile,         // a CSV that a scenario names
  kLog,             // any text: no file is recognised as one
};

/// The kinds that a command takes. `also` are tables that could be meant, too.
struct ExpectedKinds {
  std::vector<FileKind> kinds, also = {};
};

/// Returns the kinds that a file or directory may be, as far as its first bytes
/// tell; none for one of no known kind, and for one that cannot be read.
std::vector<FileKind> kinds_of(const std::filesystem::path& path);

/// Returns "a recording", "the directory of a set", ...
std::string_view kind_name(FileKind kind);

/// Returns whether the file is of that kind.
bool is_of_kind(const std::filesystem::path& path, FileKind kind);

/// Returns whether the paths are a single directory, that of a set. Throws
/// std::invalid_argument when one of several paths is a directory.
bool is_set(const std::vector<std::filesystem::path>& paths);

/// Throws std::invalid_argument when the file is of a kind that is known but
/// not expected. The message says what it is and which command takes it. A
/// file of no known kind passes, as one that cannot be read.
void require_kind(const std::filesystem::path& path,
                  const ExpectedKinds& expected);

}  // namespace beamgyro::internal
