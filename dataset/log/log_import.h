// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "dataset/log/log_map.h"
#include "dataset/log/log_report.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

struct ImportedLog {
  Recording recording;
  LogCounts counts;
  std::optional<LogCounts> joined;  // of the log that was joined
};

/// The text of the second log of a map with a join, and its name in messages.
struct SecondLog {
  std::string_view text;
  std::filesystem::path path;
};

/// Converts a log to a recording as `map` states. Rows are dropped by its rules
/// and counted. Times keep their gaps and jitter. `path` names the text in
/// messages. `joined` is the second log of a map with a join. Its quantities
/// are interpolated; a row that is not between two of its rows, or in a longer
/// gap than the map allows, is dropped. Throws std::invalid_argument
/// "file:line:column: ..." for
/// - a log that is not as the map states;
/// - a value that is no number, or not plausible in the stated unit;
/// - a unit of time that cannot be right (check_time_unit());
/// - a second log without a join in the map, or the reverse;
/// - fewer than two usable rows.
ImportedLog import_log(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map,
                       const std::optional<SecondLog>& joined = {});

}  // namespace beamgyro::internal
