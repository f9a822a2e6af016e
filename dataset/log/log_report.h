// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

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

/// Sampling of a recording. A step longer than kGapSteps median steps is a gap.
struct Sampling {
  double median_step = 0;  // [s]
  double jitter = 0;       // [s], rms of step - median step within bursts
  std::size_t bursts = 0;
  double longest_burst = 0;  // [s]
  double longest_gap = 0;    // [s]
};

Sampling sampling_of(const Recording& recording);

/// Range of a variable without its NaN.
struct ValueRange {
  std::size_t samples = 0;
  double low = 0, high = 0;
  double smallest_step = 0;  // between successive samples, 0: constant
};

/// Throws as column_values().
ValueRange range_of(const Recording& recording, std::string_view column);

}  // namespace beamgyro::internal
