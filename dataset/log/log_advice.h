// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "dataset/log/log_column.h"
#include "dataset/log/log_text.h"

namespace beamgyro::internal {

/// Returns what is expected in place of `cell`, which is no number, in the
/// present row of a log: "one such as -12.5", ... `decimal` is the decimal mark
/// of the map.
std::string number_advice(const LogText& log, char decimal,
                          std::string_view cell);

/// Returns what is expected of the present row, which has another number of
/// cells than the first line.
std::string width_advice(const LogText& log, const LogLayout& layout);

/// Returns why the log may have no column of that name, after "; ": its text is
/// not UTF-8, or its names are not cut. Empty when there is no such cause.
std::string name_advice(const LogText& log, const std::string& column);

}  // namespace beamgyro::internal
