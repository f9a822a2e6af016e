// SPDX-License-Identifier: MIT
#include "sim/scenario/profile_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <utility>

#include "config/file_error.h"

namespace beamgyro::internal {
namespace {

struct Knots {
  std::vector<double> time, value;
};

// Rows [t, value] with times that increase and values in range.
Knots read_rows(const ConfigTable& table, std::string_view key,
                const ProfileUnit& unit) {
  Knots knots;
  const auto rows = table.rows(key, 2);
  if (rows.empty()) table.fail(key, "[] is empty; expected at least one point");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = rows[i][0], value = rows[i][1];
    if (!knots.time.empty() && t <= knots.time.back()) {
      table.fail(key, i,
                 fmt::format("time {} s does not come after {} s; expected "
                             "increasing times",
                             t, knots.time.back()));
    }
    if (!unit.range.contains(value)) {
      table.fail(key, i,
                 fmt::format("{} is out of range; expected {}", value,
                             text_of(unit.range)));
    }
    knots.time.push_back(t);
    knots.value.push_back(value * unit.factor + unit.offset);
  }
  return knots;
}

PiecewiseLinear profile_of(const CsvTable& csv, const ProfileUnit& unit) {
  std::vector<double> time = csv.column("time_s");
  std::vector<double> value = csv.column(unit.csv_column);
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (i > 0 && time[i] <= time[i - 1]) {
      throw std::invalid_argument(fmt::format(
          "{}: time_s {} does not come after {}; expected increasing times",
          csv.place(i), time[i], time[i - 1]));
    }
    if (!unit.range.contains(value[i])) {
      throw std::invalid_argument(
          fmt::format("{}: {} {} is out of range; expected {}", csv.place(i),
                      unit.csv_column, value[i], text_of(unit.range)));
    }
    value[i] = value[i] * unit.factor + unit.offset;
  }
  return {std::move(time), std::move(value)};
}

}  // namespace

std::string only_form(const ConfigTable& table,
                      const std::vector<std::string>& forms) {
  std::vector<std::string> present;
  for (const std::string& form : forms) {
    if (table.has(form)) present.push_back(form);
  }
  if (present.size() == 1) return present.front();
  if (present.empty()) {
    const std::vector<std::string> keys = table.keys();
    table.fail(forms[0],
               fmt::format("missing{}; expected one of {}",
                           keys.empty() ? ""
                                        : fmt::format(", beside {}",
                                                      fmt::join(keys, ", ")),
                           fmt::join(forms, ", ")));
  }
  table.fail(present[1], fmt::format("given beside {}; expected only one of {}",
                                     present[0], fmt::join(forms, ", ")));
}

PiecewiseLinear read_points(const ConfigTable& table, const ProfileUnit& unit) {
  Knots knots = read_rows(table, "points", unit);
  return {std::move(knots.time), std::move(knots.value)};
}

PiecewiseLinear read_steps(const ConfigTable& table, const ProfileUnit& unit) {
  const Knots steps = read_rows(table, "steps", unit);
  Knots knots{{steps.time[0]}, {steps.value[0]}};
  for (std::size_t i = 1; i < steps.time.size(); ++i) {
    knots.time.insert(knots.time.end(), 2, steps.time[i]);
    knots.value.push_back(steps.value[i - 1]);
    knots.value.push_back(steps.value[i]);
  }
  return {std::move(knots.time), std::move(knots.value)};
}

PiecewiseLinear read_profile_file(const ConfigTable& table,
                                  const ProfileUnit& unit,
                                  const ProfileFolder& folder) {
  const std::filesystem::path path = folder.path / table.text("file");
  if (folder.tables != nullptr) {
    const auto known = folder.tables->find(path.lexically_normal());
    if (known != folder.tables->end()) return profile_of(known->second, unit);
  }
  if (!std::filesystem::is_regular_file(status_of(path))) {
    table.fail("file", fmt::format("\"{}\" is no file; expected a CSV file",
                                   path.string()));
  }
  return profile_of(read_csv(path), unit);
}

}  // namespace beamgyro::internal
