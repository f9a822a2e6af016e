// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace beamgyro::internal {

/// The largest file that is read as TOML [bytes].
inline constexpr std::size_t kLargestToml = std::size_t{16} << 20;

/// Checks a text before the parser reads it. Throws TomlError for a text
/// - of more than kLargestToml bytes;
/// - with more than 500,000 keys and values, because the parser takes 400 bytes
///   for each;
/// - in which keys, tables and arrays are nested deeper than 256, because the
///   parser destroys its result by recursion.
void check_toml_extent(std::string_view text);

}  // namespace beamgyro::internal
