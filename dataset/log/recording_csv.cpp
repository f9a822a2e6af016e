// SPDX-License-Identifier: MIT
#include "dataset/log/recording_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dataset/log/csv_file.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"
#include "dataset/recording/units.h"

namespace beamgyro::internal {
namespace {

constexpr double kEveryStatusBit =
    kUnpowered | kOutputSaturated | kLoopNotLocked;

/// The column of this number in its signal's unit.
Column csv_column_of(const ColumnName& about, std::vector<double> values,
                     const std::string& file) {
  const std::string_view expected = unit_of_variable(about.name);
  Column column;
  if (find_recorded_signal(about.name) != nullptr) {
    column = column_of(about.name, {});
  } else {
    column.name = about.name;
    column.units = about.unit.empty() ? "1" : about.unit;
    column.role =
        about.name.starts_with("true_") ? Role::kTruth : Role::kMeasured;
  }
  column.values = std::move(values);
  if (expected.empty() || about.unit.empty()) return column;
  try {
    const UnitConversion conversion = unit_conversion(about.unit, expected);
    if (!conversion.is_identity())
      for (double& value : column.values) value = conversion(value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}:1: {}: {}", file, about.name, error.what()));
  }
  return column;
}

std::vector<std::uint8_t> status_of_csv(const std::vector<double>& values,
                                        const CsvTable& csv) {
  std::vector<std::uint8_t> status;
  status.reserve(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(values[k] >= 0 && values[k] <= kEveryStatusBit &&
          values[k] == std::floor(values[k])))
      throw std::invalid_argument(
          fmt::format("{}: status {} is out of range; expected a whole number "
                      "from 0 to {}",
                      csv.place(k), values[k], kEveryStatusBit));
    status.push_back(static_cast<std::uint8_t>(values[k]));
  }
  return status;
}

}  // namespace

ColumnName column_name(std::string_view cell) {
  const std::size_t open = cell.rfind('[');
  if (open == cell.npos || !cell.ends_with(']')) return {std::string(cell), {}};
  std::string_view name = cell.substr(0, open);
  while (name.ends_with(' ')) name.remove_suffix(1);
  if (name.empty()) return {std::string(cell), {}};
  return {std::string(name),
          std::string(cell.substr(open + 1, cell.size() - open - 2))};
}

bool is_recording_csv(std::string_view text) {
  std::vector<std::string> names;
  try {
    names = csv_names(text, {});
  } catch (const std::invalid_argument&) {
    return false;
  }
  const auto has = [&](std::string_view wanted) {
    return std::ranges::any_of(names, [&](const std::string& cell) {
      return column_name(cell).name == wanted;
    });
  };
  return has("time") && has("status");
}

Recording parse_recording_csv(std::string_view text,
                              const std::filesystem::path& path) {
  CsvTable csv = parse_csv(text, path, true);
  const std::string file = path.string();
  Recording recording;
  recording.fidelity = "csv";
  for (std::size_t i = 0; i < csv.names.size(); ++i) {
    const ColumnName about = column_name(csv.names[i]);
    Column column = csv_column_of(about, std::move(csv.columns[i]), file);
    if (about.name == "time") {
      recording.time = std::move(column.values);
    } else if (about.name == "status") {
      recording.status = status_of_csv(column.values, csv);
    } else {
      recording.columns.push_back(std::move(column));
    }
  }
  if (recording.time.empty() || recording.status.empty())
    throw std::invalid_argument(fmt::format(
        "{}:1:1: no column '{}'; expected a recording as beamgyro writes it, "
        "with a line of names; beamgyro import reads other logs",
        file, recording.time.empty() ? "time" : "status"));
  const std::string defect = recording_defect(recording);
  if (!defect.empty())
    throw std::invalid_argument(fmt::format("{}: {}", file, defect));
  return recording;
}

}  // namespace beamgyro::internal
