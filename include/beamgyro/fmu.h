// SPDX-License-Identifier: MIT
/// \file
/// Gyros as functional mock-up units, for programs that couple simulations.
#pragma once

#include <filesystem>
#include <string>

#include "beamgyro/device.h"

namespace beamgyro {

struct FmuOptions {
  int fmi = 2;                           ///< version of the standard, 2 or 3
  std::string fidelity = "quasistatic";  ///< or "envelope"; see GyroStart
  /// The shared object beamgyro_fmu.so of this program.
  std::filesystem::path binary;
};

/// Returns the bytes of an FMU for co-simulation on 64-bit Linux: the device
/// with its overrides, a model description, and the binary
/// (docs/reference/fmu.md). They depend on these alone. Throws
/// std::invalid_argument for another version or fidelity, a device that cannot
/// be stepped in it, and a binary that cannot be read.
std::string fmu_of(const Device& device, const FmuOptions& options);

/// Writes it to a file, completely or not at all. Throws as fmu_of(), and
/// std::runtime_error when writing fails.
void write_fmu(const Device& device, const std::filesystem::path& file,
               const FmuOptions& options);

}  // namespace beamgyro
