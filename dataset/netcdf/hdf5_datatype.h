// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace beamgyro::internal {

/// Returns whether the description of a type of HDF5 ends within `bytes`, those
/// of its members included. HDF5 1.10 takes it for granted.
bool is_sound_datatype(std::span<const std::byte> bytes);

}  // namespace beamgyro::internal
