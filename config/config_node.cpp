// SPDX-License-Identifier: MIT
#include "config/config_node.h"

#include <fmt/format.h>

#include <algorithm>

namespace beamgyro {

const ConfigNode* find_child(const ConfigNode& table, std::string_view key) {
  const auto found =
      std::find_if(table.children.begin(), table.children.end(),
                   [key](const ConfigNode& child) { return child.key == key; });
  return found == table.children.end() ? nullptr : &*found;
}

ConfigNode* find_child(ConfigNode& table, std::string_view key) {
  return const_cast<ConfigNode*>(
      find_child(static_cast<const ConfigNode&>(table), key));
}

std::string text_of(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::kTable:
      return "a table";
    case ConfigNode::Kind::kArray:
      return fmt::format("an array of {}", node.children.size());
    case ConfigNode::Kind::kText:
      return '"' + printable(node.text) + '"';
    case ConfigNode::Kind::kInteger:
      return fmt::format("{}", node.integer);
    case ConfigNode::Kind::kFloat:
      return fmt::format("{}", node.number);
    case ConfigNode::Kind::kFlag:
      return node.flag ? "true" : "false";
    case ConfigNode::Kind::kDate:
      return "a date or time";
  }
  return {};
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 120;
  std::string line;
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      line += fmt::format("\\x{:02x}", byte);
    } else {
      line += c;
    }
  }
  if (text.size() <= kLongest) return line;
  // Never end in the middle of a UTF-8 character.
  std::size_t end = line.size();
  while (end > 0 && (static_cast<unsigned char>(line[end - 1]) & 0xC0) == 0x80)
    --end;
  if (end > 0 && static_cast<unsigned char>(line[end - 1]) >= 0xC0) --end;
  return line.substr(0, end) + "...";
}

}  // namespace beamgyro
