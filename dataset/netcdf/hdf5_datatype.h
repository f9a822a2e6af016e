// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace beamgyro::internal {

/// Returns the size of a value of the type that `bytes` describe; nothing where
/// the description does not end within them, or where a part of a value does
/// not end within the value. HDF5 1.10 takes both for granted.
std::optional<std::uint64_t> size_of_datatype(std::span<const std::byte> bytes);

}  // namespace beamgyro::internal
