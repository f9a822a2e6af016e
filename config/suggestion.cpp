// SPDX-License-Identifier: MIT
#include "config/suggestion.h"

#include <algorithm>
#include <numeric>

namespace beamgyro::internal {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string suggestion(std::string_view word,
                       const std::vector<std::string>& candidates) {
  // A word of more than 200 characters is not a mistyped key.
  if (word.empty() || word.size() > 200) return {};
  const std::string typed = lower_case(word);
  std::size_t nearest = 2 + typed.size() / 4;  // first distance too far
  std::string best;
  for (const std::string& candidate : candidates) {
    const std::string lower = lower_case(candidate);
    const std::size_t distance =
        lower.starts_with(typed + "_") ? 1 : edit_distance(typed, lower);
    if (distance < nearest && distance < std::max(typed.size(), lower.size())) {
      nearest = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace beamgyro::internal
