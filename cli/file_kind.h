// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
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
  kCharacteristic,  // what characterise writes
  kResult,          // what --json writes
  kProfile,         // a CSV that a scenario names
  kLog,             // any text: no file is recognised as one
};

/// The kinds that a command takes. `also` are tables that could be meant, too.
struct ExpectedKinds {
  std::vector<FileKind> kinds, also = {};
};

/// Returns whether the file is of that kind, as far as its first bytes tell.
bool is_of_kind(const std::filesystem::path& path, FileKind kind);

/// Throws std::invalid_argument when the file is of a kind that is known but
/// not expected. The message says what it is and which command takes it. A
/// file of no known kind passes, as one that cannot be read.
void require_kind(const std::filesystem::path& path,
                  const ExpectedKinds& expected);

}  // namespace beamgyro::internal
