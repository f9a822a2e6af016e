// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dataset/log/log_import.h"
#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Returns what a recording holds: its origin, its samples by their status, and
/// a line for each variable with unit, role and range. `path` is its name.
std::string recording_report(const std::string& path,
                             const Recording& recording);

/// Returns what an import read and left out: rows and the reasons why some were
/// dropped, sampling, ranges of the rate and the temperature. `path` is the
/// name of the log, `joined` that of the second one.
std::string import_report(const ImportedLog& log, const std::string& path,
                          const std::string& joined = "");

}  // namespace beamgyro::internal
