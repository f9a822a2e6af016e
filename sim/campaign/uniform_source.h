// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "sim/campaign/scrambled_sobol.h"

namespace beamgyro::internal {

/// Returns the number of the stream called `name` (CRC-32 of ISO 3309).
std::uint32_t stream_number(std::string_view name);

/// The source of the uniform numbers of a campaign: a random stream for each
/// name, or the coordinates of Sobol' points.
struct UniformSource {
  std::uint64_t seed = 0;
  std::optional<ScrambledSobol> sobol;

  /// Returns a number in (0, 1). It depends on seed, device and stream alone,
  /// or on seed, device and dimension.
  double number(std::uint32_t device, std::uint32_t stream,
                std::size_t dimension) const;
};

}  // namespace beamgyro::internal
