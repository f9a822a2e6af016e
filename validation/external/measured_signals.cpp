// SPDX-License-Identifier: MIT
#include "validation/external/measured_signals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "dataset/recording/signals.h"

namespace beamgyro::internal {
namespace {

constexpr std::string_view kStatus = "status";

[[noreturn]] void refuse_signal(std::string_view name) {
  throw std::invalid_argument(fmt::format(
      "asks for \"{}\", which no gyro measures; expected measured variables",
      name));
}

}  // namespace

void require_measurable(std::string_view name) {
  const RecordedSignal* known = find_recorded_signal(name);
  if (name.empty() || name == "time" || name.starts_with("true_") ||
      (known != nullptr && known->role != Role::kMeasured))
    refuse_signal(name);
}

std::vector<std::string> measured_names(const Recording& run) {
  std::vector<std::string> names;
  for (const Column& column : run.columns)
    if (column.role == Role::kMeasured) names.push_back(column.name);
  names.emplace_back(kStatus);
  return names;
}

MeasuredSignals::MeasuredSignals(const Recording& run,
                                 const std::vector<std::string>& names)
    : status_(run.status.data()) {
  for (const std::string& name : names) {
    if (name == kStatus) {
      values_.push_back(nullptr);
      continue;
    }
    const Column* column = find_column(run, name);
    if (column == nullptr)
      throw std::invalid_argument(
          fmt::format("the recording has no variable '{}'; it measures {}",
                      name, fmt::join(measured_names(run), ", ")));
    if (column->role != Role::kMeasured) refuse_signal(name);
    values_.push_back(column->values.data());
  }
}

}  // namespace beamgyro::internal
