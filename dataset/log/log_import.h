// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "dataset/log/log_map.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Reason why a row of a log was dropped.
enum class DropReason : std::uint8_t {
  kFiltered,
  kRagged,
  kMissing,
  kDuplicate,
  kBackward,
  kRateOutlier,
  kTemperatureOutlier,
  kOutside,
  kNotJoined,
};
constexpr std::size_t kDropReasons = 9;

/// Returns the name for reports: "missing values", ...
const char* reason_name(DropReason reason);

struct DroppedRows {
  std::size_t rows = 0;
  std::size_t first_line = 0;  // from 1
};

/// The signal beside the gyro that is missing in most rows.
struct BlankSignal {
  std::string signal;
  std::size_t rows = 0;  // dropped because it is missing
};

/// Number of rows that an import read, kept and dropped.
struct LogCounts {
  std::size_t rows = 0, kept = 0;
  std::array<DroppedRows, kDropReasons> dropped;  // by DropReason
  BlankSignal most_blank;

  void drop(DropReason reason, std::size_t line);
  /// Returns whether most_blank costs more rows than are kept. The log joined
  /// with itself keeps them.
  bool is_mostly_blank() const { return most_blank.rows > kept; }
};

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
