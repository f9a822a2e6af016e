// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/document.h"
#include "dataset/log/log_column.h"
#include "dataset/log/log_text.h"

namespace beamgyro::internal {

/// Selects the rows that are read: those whose cell in `column` is `text` or
/// equals `number`.
struct LogFilter {
  LogColumn column;
  std::string text;
  std::optional<double> number;
};

/// Defines which numbers of a column set which bit of the status.
struct LogStatus {
  LogColumn column;
  std::vector<long> unpowered, saturated, not_locked;
  std::optional<std::vector<long>> valid;  // every other one: not locked

  std::uint8_t bits(double value) const;  // StatusBit mask
};

/// A value is an outlier when
///   |x - median| > k max(1.4826 MAD, resolution),
/// with median and median absolute deviation (MAD) over the `window` nearest
/// rows of its burst. `resolution` is the smallest step between two rows of the
/// log.
struct OutlierRule {
  std::size_t window = 25;  // odd
  double k = 20;
};

/// Whether rows with a defect are dropped; otherwise they are errors.
struct LogRules {
  bool drop_ragged = false;
  bool fill_short = false;  // cells that a row lacks at its end are empty
  bool drop_missing = true;
  bool drop_duplicates = true;  // a time equal to that of the last row kept
  bool drop_backward = false;   // a time before it
  bool keep_fast_temperature = false;  // else an error, as of a wrong unit
  std::optional<OutlierRule> outliers;
};

struct LogMap;

/// A second log on the same clock, whose values are interpolated at the times
/// of the first. `map` has its quantities and no gyro.
struct LogJoin {
  std::shared_ptr<const LogMap> map;
  double longest_gap = 0;  // [s], between two rows that are interpolated
  std::string place;       // of its table in the map
};

/// States how a log becomes a recording: the map of docs/reference/log_map.md.
struct LogMap {
  LogLayout layout;
  std::vector<std::string> missing_markers;  // beside "", nan and NA
  std::optional<LogFilter> filter;
  LogTime time;
  std::vector<LogQuantity> quantities;  // in the order of the recording
  std::optional<LogStatus> status;
  // [on, off) [s]; off may be infinite; none: powered throughout
  std::vector<std::array<double, 2>> powered;
  std::optional<double> constant_true_rate;  // [deg/s]
  LogRules rules;
  std::optional<LogJoin> join;
  std::string text;  // byte for byte as read
};

/// Reads a map. `axis` is one of its axes ("x", "y", "z"), or empty when it has
/// one gyro only. Throws std::invalid_argument for an unknown or wrong key and
/// for an axis that the map lacks.
LogMap read_log_map(const ConfigDocument& document, const std::string& axis);

}  // namespace beamgyro::internal
