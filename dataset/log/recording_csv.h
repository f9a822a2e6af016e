// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// The name of a column of a CSV: "rate [deg/h]" is the column `rate` in the
/// unit deg/h. Without brackets the unit is empty.
struct ColumnName {
  std::string name, unit;
};
ColumnName column_name(std::string_view cell);

/// Returns whether `text` is a recording as CSV: its first line names `time`
/// and `status`.
bool is_recording_csv(std::string_view text);

/// Reads a recording that was written as CSV, from a text called `path` in
/// messages. A column has the unit in brackets after its name, or else that of
/// the signal of its name (recorded_signals()), and is converted to that of the
/// signal. A column that is no signal is a truth when its name begins with
/// `true_`, else measured. The texts and the seed of a recording are not in a
/// CSV; the fidelity is "csv". Throws std::invalid_argument as parse_csv(), for
/// a missing `time` or `status`, an unknown unit, a status that is no set of
/// StatusBit, and for a defect (recording_defect()).
Recording parse_recording_csv(std::string_view text,
                              const std::filesystem::path& path);

}  // namespace beamgyro::internal
