// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace beamgyro::internal {

/// Returns the first bytes of a text, `most` or up to three fewer, so that it
/// does not end within a letter of UTF-8. The whole text where it is shorter.
inline std::string_view cut_text(std::string_view text, std::size_t most) {
  const auto is_inner = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
  };
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && most - end < 3 && is_inner(text[end])) --end;
  return text.substr(0, is_inner(text[end]) ? most : end);
}

}  // namespace beamgyro::internal
