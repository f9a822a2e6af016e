// SPDX-License-Identifier: MIT
#include "dataset/recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace beamgyro {

std::string_view role_name(Role role) {
  switch (role) {
    case Role::kMeasured:
      return "measured";
    case Role::kTruth:
      return "truth";
    case Role::kCompensated:
      return "compensated";
  }
  return {};
}

const Column* find_column(const Recording& recording, std::string_view name) {
  const auto found = std::find_if(
      recording.columns.begin(), recording.columns.end(),
      [name](const Column& column) { return column.name == name; });
  return found == recording.columns.end() ? nullptr : &*found;
}

const std::vector<double>& column_values(const Recording& recording,
                                         std::string_view name) {
  if (const Column* column = find_column(recording, name))
    return column->values;
  std::vector<std::string_view> names;
  for (const Column& column : recording.columns) names.push_back(column.name);
  throw std::invalid_argument(fmt::format(
      "the recording has no variable '{}'; it has {}", name,
      names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

namespace internal {

std::size_t status_position(const Recording& recording) {
  const auto first = std::find_if(
      recording.columns.begin(), recording.columns.end(),
      [](const Column& column) { return column.role != Role::kMeasured; });
  return static_cast<std::size_t>(first - recording.columns.begin());
}

}  // namespace internal
}  // namespace beamgyro
