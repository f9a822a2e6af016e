// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/table.h"
#include "dataset/log/csv_file.h"
#include "sim/numerics/piecewise_linear.h"

namespace beamgyro::internal {

/// Unit of the numbers of a profile in files: value = file value x factor +
/// offset. `range` limits the file value.
struct ProfileUnit {
  std::string csv_column;
  double factor, offset;
  Range range;
};

/// Returns the one key among `forms` that `table` holds. Throws
/// std::invalid_argument when there is none or more than one.
std::string only_form(const ConfigTable& table,
                      const std::vector<std::string>& forms);

/// Reads `points = [[t_s, value], ...]`, with straight lines between the
/// points.
PiecewiseLinear read_points(const ConfigTable& table, const ProfileUnit& unit);

/// Reads `steps = [[t_s, value], ...]`; each value is held until the next.
PiecewiseLinear read_steps(const ConfigTable& table, const ProfileUnit& unit);

/// Profile files that were read before, by their lexically normal path.
using ProfileTables = std::map<std::filesystem::path, CsvTable>;

/// The folder of profile files. Names are relative to `path`. A file that is in
/// `tables` is not read again; `tables` may be null.
struct ProfileFolder {
  std::filesystem::path path;
  const ProfileTables* tables;
};

/// Reads `file = "profile.csv"` with the columns time_s and `unit.csv_column`.
PiecewiseLinear read_profile_file(const ConfigTable& table,
                                  const ProfileUnit& unit,
                                  const ProfileFolder& folder);

}  // namespace beamgyro::internal
