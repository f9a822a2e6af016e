// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <optional>

#include "config/option_message.h"
#include "config/range.h"

namespace beamgyro::internal {

/// Throws OptionError for an option called `name` that is beyond its range or
/// not finite.
inline void check_number(const char* name, std::optional<double> value,
                         const Range& range) {
  if (value && !range.contains(*value))
    throw option_error("{}; expected {}",
                       NamedOption{name, fmt::format("{:g}", *value)},
                       text_of(range));
}

/// The same for temperatures of which the first must be below the second, both
/// `allowed` [degC].
inline void check_range(const char* name, double low, double high,
                        const Range& allowed) {
  if (!(low < high) || !allowed.contains(low) || !allowed.contains(high))
    throw option_error(
        "{}: not a range; expected LOW below HIGH, within {:g} to {:g} degC",
        NamedOption{name, fmt::format("{:g}:{:g}", low, high)}, allowed.low,
        allowed.high);
}

}  // namespace beamgyro::internal
