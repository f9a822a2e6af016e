// SPDX-License-Identifier: MIT
#include "api/key_overrides.h"

#include <algorithm>

namespace beamgyro::internal {

std::string_view key_of_override(std::string_view text) {
  std::string_view key = text.substr(0, text.find('='));
  while (!key.empty() && key.front() == ' ') key.remove_prefix(1);
  while (!key.empty() && key.back() == ' ') key.remove_suffix(1);
  return key;
}

std::vector<std::string> merged_overrides(
    const std::vector<std::string>& first,
    const std::vector<std::string>& later) {
  std::vector<std::string> all = first;
  std::erase_if(all, [&](const std::string& text) {
    return std::ranges::count(later, key_of_override(text), key_of_override) >
           0;
  });
  all.insert(all.end(), later.begin(), later.end());
  return all;
}

}  // namespace beamgyro::internal
