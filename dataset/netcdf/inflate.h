// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace beamgyro::internal {

/// Returns whether `packed`, a stream of zlib as HDF5's filter deflate makes
/// it, inflates to `size` bytes.
bool inflates_to(std::span<const std::byte> packed, std::size_t size);

}  // namespace beamgyro::internal
