// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace beamgyro::internal {

/// Returns 64 random bits of the operating system. Throws std::system_error
/// when it has none.
std::uint64_t system_random_bits();

}  // namespace beamgyro::internal
