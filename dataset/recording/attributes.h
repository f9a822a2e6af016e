// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

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
