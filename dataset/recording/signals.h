// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// A signal that recordings hold, as their files describe it.
struct RecordedSignal {
  std::string_view name, units, long_name;
  Role role = Role::kMeasured;
  std::string_view standard_name = {};  // of the CF conventions
  bool is_fine = false;  // truth whose steps in single precision are too large
};

/// Every signal that this program records, imports or computes, in the order of
/// a recording's columns. A new one is a line of this table.
std::span<const RecordedSignal> recorded_signals();

/// The signal of that name, or nullptr.
const RecordedSignal* find_recorded_signal(std::string_view name);

/// Throws std::logic_error for a name that is not in the table.
const RecordedSignal& recorded_signal(std::string_view name);

/// A column of that signal. Throws as recorded_signal().
Column column_of(std::string_view name, std::vector<double> values);

/// Returns the unit of the variable of this name in recordings: of a signal, of
/// `time` or of `status`. Empty for another name.
std::string_view unit_of_variable(std::string_view name);

/// Returns the CF standard name of a variable, empty where there is none.
std::string_view standard_name_of(std::string_view name);

/// The root attribute `Conventions` of every file.
inline constexpr const char* kConventions = "CF-1.10";

/// The attributes flag_masks and flag_meanings of `status`.
inline constexpr std::array<std::uint8_t, 3> kStatusMasks = {
    kUnpowered, kOutputSaturated, kLoopNotLocked};
inline constexpr const char* kStatusMeanings =
    "unpowered output_saturated loop_not_locked";

/// A variable, with its attributes.
struct VariableAbout {
  std::string name, units, long_name;
  Role role = Role::kMeasured;
  std::string comment = {};  // no attribute when empty
};

/// Returns the variable `status`.
VariableAbout status_about();

/// Returns the CF attribute `source`: how the data were made, and by what.
std::string source_text(std::string_view fidelity,
                        std::string_view program_version,
                        std::string_view git_revision);

}  // namespace beamgyro::internal
