// SPDX-License-Identifier: MIT
#include "compensation/firmware/runtime.h"

#include <fmt/format.h>

#include <stdexcept>

namespace beamgyro::internal {
namespace {

constexpr std::string_view kText =
#include "compensation/firmware/runtime_text.h"
    ;
constexpr std::string_view kMark = "/* @section ";

}  // namespace

const std::vector<std::string_view>& runtime_sections() {
  static const std::vector<std::string_view> sections = [] {
    std::vector<std::string_view> names;
    for (std::size_t at = kText.find(kMark); at != std::string_view::npos;
         at = kText.find(kMark, at + 1)) {
      const std::size_t begin = at + kMark.size();
      names.push_back(kText.substr(begin, kText.find(' ', begin) - begin));
    }
    return names;
  }();
  return sections;
}

std::string runtime_text(std::string_view section) {
  const std::string mark = fmt::format("{}{} */\n", kMark, section);
  const std::size_t begin = kText.find(mark);
  if (begin == std::string_view::npos)
    throw std::logic_error(
        fmt::format("no section {} of the run-time", section));
  const std::size_t from = begin + mark.size();
  return std::string(kText.substr(from, kText.find(kMark, from) - from));
}

}  // namespace beamgyro::internal
