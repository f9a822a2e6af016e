// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <string>
#include <type_traits>

#include "include/beamgyro/option_error.h"

namespace beamgyro::internal {

/// An option in a message, with a value if that is not empty.
struct NamedOption {
  std::string name, value = {};
};

template <class T>
using Spelled =
    std::conditional_t<std::is_same_v<T, NamedOption>, std::string, T>;

template <class T>
Spelled<T> spelled_part(const T& part, const OptionSpelling& spelled) {
  if constexpr (std::is_same_v<T, NamedOption>)
    return spelled(part.name, part.value);
  else
    return part;
}

/// Returns an error whose message is `format` with these parts, each
/// NamedOption as its reader spells it. The parts are copied.
template <class... Parts>
OptionError option_error(fmt::format_string<Spelled<Parts>...> format,
                         Parts... parts) {
  return OptionError([=](const OptionSpelling& spelled) {
    return fmt::format(format, spelled_part(parts, spelled)...);
  });
}

}  // namespace beamgyro::internal
