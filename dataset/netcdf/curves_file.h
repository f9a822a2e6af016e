// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dataset/recording/signals.h"

namespace beamgyro::internal {

inline constexpr const char* kCurvesFiletype = "beamgyro-curves";
inline constexpr std::int32_t kCurvesFormatVersion = 1;

/// A quantity over device and temperature, the values of a device together.
struct CurvesVariable {
  VariableAbout about;
  std::span<const double> values;
};

/// What a file of curves holds.
struct CurvesContent {
  std::string program_version, git_revision, fidelity;
  std::uint64_t seed = 0;
  std::string campaign_text, device_text;  // byte for byte as read
  std::vector<std::int64_t> devices;       // numbers, one or more
  std::span<const double> temperatures;    // [degC], one or more
  std::vector<CurvesVariable> variables;
};

/// Writes curves as HDF5 in the layout of netCDF-4: dimension scales device and
/// temperature, a variable over both for each quantity, the texts below /meta,
/// and a checksum at the end. The file appears under its name when it is
/// complete (AtomicFile). Throws std::invalid_argument for a name that cannot
/// be written, std::runtime_error when writing fails.
void write_curves_file(const std::filesystem::path& path,
                       const CurvesContent& content);

}  // namespace beamgyro::internal
