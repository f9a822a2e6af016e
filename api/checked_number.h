// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "config/range.h"

namespace beamgyro::internal {

/// Throws std::invalid_argument for an option called `what` that is beyond its
/// range or not finite.
inline void check_number(const char* what, std::optional<double> value,
                         const Range& range) {
  if (value && !range.contains(*value))
    throw std::invalid_argument(
        fmt::format("{} {:g}; expected {}", what, *value, text_of(range)));
}

}  // namespace beamgyro::internal
