// SPDX-License-Identifier: MIT
#include "api/device_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace beamgyro::internal {
namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return "";
  return std::string(
      text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

// Returns a line of TOML without its comment.
std::string_view without_comment(std::string_view line) {
  char quote = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (quote != 0)
      quote = line[k] == quote ? '\0' : quote;
    else if (line[k] == '"' || line[k] == '\'')
      quote = line[k];
    else if (line[k] == '#')
      return line.substr(0, k);
  }
  return line;
}

// Six digits state a figure; more would only repeat how it was computed.
std::string number_text(double value) { return fmt::format("{:.6g}", value); }

}  // namespace

DeviceText::DeviceText(const std::string& text, const std::string& name,
                       const std::string& origin) {
  std::istringstream stream(text);
  std::string line, table;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string content = trimmed(without_comment(line));
    if (content.empty()) continue;
    if (content.front() == '[') {
      table = trimmed(std::string_view(content).substr(1, content.size() - 2));
      lines_.push_back({table, "", "", ""});
      continue;
    }
    const std::size_t equals = content.find('=');
    if (equals == content.npos ||
        std::ranges::count(content, '[') != std::ranges::count(content, ']'))
      throw std::invalid_argument(fmt::format(
          "{}:{}: a value on several lines; expected each key with its value "
          "on a line",
          name, number));
    lines_.push_back({table, trimmed(content.substr(0, equals)),
                      trimmed(content.substr(equals + 1)), origin});
  }
}

const DeviceText::Line* DeviceText::find(const std::string& key) const {
  const auto found = std::ranges::find_if(lines_, [&](const Line& line) {
    return !line.key.empty() && line.table + "." + line.key == key;
  });
  return found == lines_.end() ? nullptr : &*found;
}

DeviceText::Line* DeviceText::find(const std::string& key) {
  return const_cast<Line*>(std::as_const(*this).find(key));
}

std::vector<double> DeviceText::numbers(const std::string& key) const {
  const Line* line = find(key);
  std::vector<double> values;
  if (line == nullptr) return values;
  std::string text = line->value;
  std::erase(text, '_');
  std::ranges::replace_if(
      text, [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double value = std::strtod(at, &end);
    if (end == at) return values;
    values.push_back(value);
  }
}

void DeviceText::put(const std::string& key, const std::string& value,
                     const std::string& comment) {
  if (Line* line = find(key)) {
    line->value = value;
    line->comment = comment;
    return;
  }
  const std::size_t dot = key.rfind('.');
  const std::string table = key.substr(0, dot);
  const auto last =
      std::find_if(lines_.rbegin(), lines_.rend(),
                   [&](const Line& line) { return line.table == table; });
  lines_.insert(last.base(), {table, key.substr(dot + 1), value, comment});
}

void DeviceText::set(const std::string& key, double value,
                     const std::string& comment) {
  put(key, number_text(value), comment);
}

void DeviceText::set(const std::string& key, const std::vector<double>& values,
                     const std::string& comment) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + number_text(value);
  put(key, "[" + text + "]", comment);
}

void DeviceText::scale(const std::string& key, double factor,
                       const std::string& comment) {
  std::vector<double> values = numbers(key);
  if (values.empty() || factor == 1) return;
  for (double& value : values) value *= factor;
  if (find(key)->value.front() == '[')
    set(key, values, comment);
  else
    set(key, values[0], comment);
}

std::string DeviceText::text(const std::vector<std::string>& heading) const {
  std::string text;
  for (const std::string& line : heading) text += "# " + line + "\n";
  for (const Line& line : lines_)
    text += line.key.empty() ? fmt::format("\n[{}]\n", line.table)
                             : fmt::format("{} = {}   # {}\n", line.key,
                                           line.value, line.comment);
  return text;
}

}  // namespace beamgyro::internal
