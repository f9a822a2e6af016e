// SPDX-License-Identifier: MIT
#include "dataset/recording/recording_defect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "dataset/recording/signals.h"

namespace beamgyro::internal {
namespace {

bool is_identifier(std::string_view name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !name.empty() && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
         });
}

std::string defect_of_time(const std::vector<double>& time, std::size_t first) {
  if (time.empty()) return "time: no samples; expected at least one";
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (!std::isfinite(time[k]))
      return fmt::format("time: sample {} is {}; expected a finite time",
                         first + k, time[k]);
    if (k > 0 && !(time[k] > time[k - 1]))
      return fmt::format("time: sample {} is {} s, not after {} s before it",
                         first + k, time[k], time[k - 1]);
  }
  return {};
}

std::string defect_of_names(const Recording& recording) {
  std::set<std::string_view> names{"time", "status", "meta"};
  for (const Column& column : recording.columns) {
    if (!is_identifier(column.name))
      return fmt::format(
          "'{}' is no name for a variable; expected a letter, "
          "then letters, digits and '_'",
          column.name);
    if (!names.insert(column.name).second)
      return fmt::format("{}: the name is taken", column.name);
  }
  return {};
}

std::string defect_of_texts(const Recording& recording) {
  const auto holds_nul = [](const std::string& text) {
    return text.find('\0') != std::string::npos;
  };
  for (const Column& column : recording.columns) {
    if (holds_nul(column.units) || holds_nul(column.long_name) ||
        holds_nul(column.comment))
      return fmt::format("{}: a NUL in units, long_name or comment",
                         column.name);
    const RecordedSignal* signal = find_recorded_signal(column.name);
    if (signal == nullptr) continue;
    if (!column.units.empty() && column.units != signal->units)
      return fmt::format("{}: unit '{}'; expected '{}'", column.name,
                         column.units, signal->units);
    // A truth that calls itself measured would be given to compensators.
    if (column.role != signal->role)
      return fmt::format("{}: role '{}'; expected '{}'", column.name,
                         role_name(column.role), role_name(signal->role));
  }
  for (const std::string* text :
       {&recording.title, &recording.history, &recording.compensator,
        &recording.compensator_sha256, &recording.fidelity,
        &recording.program_version, &recording.git_revision,
        &recording.scenario_text, &recording.device_text,
        &recording.overrides_text}) {
    if (holds_nul(*text)) return "a NUL in the texts of the recording";
  }
  return {};
}

std::string defect_of_values(const Column& column,
                             const std::vector<std::uint8_t>& status,
                             std::size_t first) {
  const std::vector<double>& values = column.values;
  if (values.size() != status.size())
    return fmt::format("{}: {} values for {} times", column.name, values.size(),
                       status.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(values[k]) > kLargestValue && std::isfinite(values[k]))
      return fmt::format("{}: sample {} is {:g}; expected at most +-{:g}",
                         column.name, first + k, values[k], kLargestValue);
    if (std::isfinite(values[k])) continue;
    if (column.role == Role::kTruth)
      return fmt::format("{}: sample {} is {}; a truth is always finite",
                         column.name, first + k, values[k]);
    if ((status[k] & kUnpowered) == 0)
      return fmt::format(
          "{}: sample {} is {} while powered; expected a finite "
          "value",
          column.name, first + k, values[k]);
    if (!std::isnan(values[k]))
      return fmt::format("{}: sample {} is {} while unpowered; expected nan",
                         column.name, first + k, values[k]);
  }
  return {};
}

}  // namespace

std::string head_defect(const Recording& recording) {
  const std::string defect = defect_of_names(recording);
  return defect.empty() ? defect_of_texts(recording) : defect;
}

std::string samples_defect(const Recording& recording, std::size_t first) {
  std::string defect = defect_of_time(recording.time, first);
  if (defect.empty() && recording.status.size() != recording.time.size())
    defect = fmt::format("status: {} values for {} times",
                         recording.status.size(), recording.time.size());
  for (const Column& column : recording.columns) {
    if (!defect.empty()) return defect;
    defect = defect_of_values(column, recording.status, first);
  }
  return defect;
}

std::string recording_defect(const Recording& recording) {
  const std::string defect = head_defect(recording);
  return defect.empty() ? samples_defect(recording, 0) : defect;
}

}  // namespace beamgyro::internal
