// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "dataset/log/log_map.h"
#include "dataset/log/log_report.h"
#include "dataset/recording/recording.h"

namespace beamgyro {

struct ImportedLog {
  Recording recording;
  LogCounts counts;
};

/// Converts a log to a recording as `map` states. Rows are dropped by its rules
/// and counted. Times keep their gaps and jitter. `path` names the text in
/// messages. Throws std::invalid_argument "file:line:column: ..." for
/// - a log that is not as the map states;
/// - a value that is no number, or not plausible in the stated unit;
/// - fewer than two usable rows.
ImportedLog import_log(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map);

}  // namespace beamgyro
