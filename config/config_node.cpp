// SPDX-License-Identifier: MIT
#include "config/config_node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace beamgyro::internal {

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

namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\u{:04x}", byte);
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result + '"';
}

// fmt's shortest digits; a mark that keeps an integral float a float.
std::string float_text(double number) {
  const std::string digits = fmt::format("{}", number);
  const bool integral = digits.find_first_of(".en") == std::string::npos;
  return integral ? digits + ".0" : digits;
}

}  // namespace

std::string toml_text(const ConfigNode& node) {
  std::vector<std::string> parts;
  for (const ConfigNode& child : node.children) {
    const std::string text = toml_text(child);
    parts.push_back(node.kind == ConfigNode::Kind::kTable
                        ? fmt::format("{} = {}", in_quotes(child.key), text)
                        : text);
  }
  switch (node.kind) {
    case ConfigNode::Kind::kTable:
      return fmt::format("{{{}}}", fmt::join(parts, ", "));
    case ConfigNode::Kind::kArray:
      return fmt::format("[{}]", fmt::join(parts, ", "));
    case ConfigNode::Kind::kText:
      return in_quotes(node.text);
    case ConfigNode::Kind::kInteger:
      return fmt::format("{}", node.integer);
    case ConfigNode::Kind::kFloat:
      return float_text(node.number);
    case ConfigNode::Kind::kFlag:
      return node.flag ? "true" : "false";
    case ConfigNode::Kind::kDate:
      return {};
  }
  return {};
}

ConfigNode number_node(double number) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kFloat;
  node.number = number;
  return node;
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

}  // namespace beamgyro::internal
