// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn
/// `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate somebody who typed `word` most likely meant, or an empty text
/// when none is near. Upper and lower case count as equal, and a missing unit
/// ("length" for "length_m") as one edit; the first of equally near candidates
/// wins.
std::string suggestion(std::string_view word,
                       const std::vector<std::string>& candidates);

}  // namespace beamgyro
