// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "dataset/log_map.h"
#include "dataset/log_report.h"
#include "dataset/recording.h"

namespace beamgyro {

struct ImportedLog {
  Recording recording;
  LogCounts counts;
};

/// The recording that `map` makes of a log. Rows are dropped as its rules say
/// and counted; times stay what they are, gaps and jitter included. `path`
/// names the text in messages. Throws std::invalid_argument "file:line:column:
/// ..." for a log that is not as the map says, for a value that is no number or
/// not plausible in the unit stated, and for fewer than two usable rows.
ImportedLog import_log(std::string_view text, const std::filesystem::path& path,
                       const LogMap& map);

}  // namespace beamgyro
