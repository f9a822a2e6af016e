// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace beamgyro {

/// The largest file that is read as TOML [bytes].
inline constexpr std::size_t kLargestToml = std::size_t{16} << 20;

/// Throws TomlError for a text of more than kLargestToml bytes, of more than
/// 500,000 keys and values, or in which keys, tables and arrays nest deeper
/// than 256: the parser destroys what it has read by recursion, and takes 400
/// bytes for a value. Looks at the text alone, before the parser does.
void check_toml_extent(std::string_view text);

}  // namespace beamgyro
