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

}  // namespace beamgyro::internal
