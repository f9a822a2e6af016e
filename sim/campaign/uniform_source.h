// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/campaign/scrambled_sobol.h"

namespace beamgyro {

/// The number of the stream called `name` (CRC-32 of ISO 3309).
std::uint32_t stream_number(std::string_view name);

/// Where the uniform numbers of a campaign come from: a random stream of its
/// own for each name, or the coordinates of Sobol' points.
struct UniformSource {
  std::uint64_t seed = 0;
  std::optional<ScrambledSobol> sobol;

  /// In (0, 1); depends on seed, device and stream alone, or on seed, device
  /// and dimension.
  double number(std::uint32_t device, std::uint32_t stream,
                std::size_t dimension) const;
};

}  // namespace beamgyro
