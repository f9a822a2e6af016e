// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "dataset/log/log_import.h"
#include "dataset/recording/recording_defect.h"

namespace beamgyro::internal {

/// The columns of a log whose rate is "w" and whose temperature is "T".
inline std::string gyro_and_temperature() {
  return R"([gyro]
column = "w"
unit = "deg/s"
[temperature]
column = "T"
unit = "degC"
)";
}

/// A map whose log has the time "t" and the rate "w" and is joined, over at
/// most `gap` s, with one of the time "t" and the temperature "T".
inline std::string joining_map(const std::string& time,
                               const std::string& second_time,
                               const std::string& gap) {
  return "[time]\ncolumn = \"t\"\n" + time +
         "[gyro]\ncolumn = \"w\"\nunit = \"deg/s\"\n[join]\nmax_gap_s = " +
         gap + "\n[join.time]\ncolumn = \"t\"\n" + second_time +
         "[join.temperature]\ncolumn = \"T\"\nunit = \"degC\"\n";
}

/// Imports a log "log.csv" by a map "map.toml", with a second log "second.csv"
/// unless that is empty. Expects a recording without a defect.
inline ImportedLog imported(const std::string& map, const std::string& text,
                            const std::string& second = "") {
  std::optional<SecondLog> joined;
  if (!second.empty()) joined = SecondLog{second, "second.csv"};
  ImportedLog log = import_log(
      text, "log.csv", read_log_map(ConfigDocument::parse(map, "map.toml"), ""),
      joined);
  EXPECT_EQ(recording_defect(log.recording), "");
  return log;
}

}  // namespace beamgyro::internal
