// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// Returns the smallest number of insertions, deletions, replacements and swaps
/// of neighbours that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns the candidate nearest to `word`, or an empty text when none is near.
/// Upper and lower case count as equal, and a missing unit ("length" for
/// "length_m") counts as one edit. Of equally near candidates the first is
/// taken.
std::string suggestion(std::string_view word,
                       const std::vector<std::string>& candidates);

}  // namespace beamgyro::internal
