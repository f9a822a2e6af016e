// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/table.h"
#include "dataset/csv_file.h"
#include "sim/numerics/piecewise_linear.h"

namespace beamgyro {

/// How the numbers of a profile are written in files: value = file value x
/// factor + offset, `range` holds for the file value.
struct ProfileUnit {
  std::string csv_column;
  double factor, offset;
  Range range;
};

/// The one key among `forms` that `table` holds. Throws std::invalid_argument
/// when there is none or more than one.
std::string only_form(const ConfigTable& table,
                      const std::vector<std::string>& forms);

/// `points = [[t_s, value], ...]`, linear between.
PiecewiseLinear read_points(const ConfigTable& table, const ProfileUnit& unit);

/// `steps = [[t_s, value], ...]`, each held until the next.
PiecewiseLinear read_steps(const ConfigTable& table, const ProfileUnit& unit);

/// Profile files read before, by their lexically normal path.
using ProfileTables = std::map<std::filesystem::path, CsvTable>;

/// Where profile files are: relative to `path`, and not read again when they
/// are in `tables`, which may be null.
struct ProfileFolder {
  std::filesystem::path path;
  const ProfileTables* tables;
};

/// `file = "profile.csv"` with the columns time_s and `unit.csv_column`.
PiecewiseLinear read_profile_file(const ConfigTable& table,
                                  const ProfileUnit& unit,
                                  const ProfileFolder& folder);

}  // namespace beamgyro
