// SPDX-License-Identifier: MIT
#include "config/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/config_node.h"
#include "config/document_state.h"
#include "config/suggestion.h"
#include "config/value_reading.h"

namespace beamgyro::internal {
namespace {

std::string read_choice(const ConfigValue& value,
                        const std::vector<std::string>& allowed) {
  const std::string text = read_text(value);
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end())
    return text;
  const std::string near = suggestion(text, allowed);
  value.fail(fmt::format(
      "{} is not known; {}expected one of \"{}\"", text_of(value.node),
      near.empty() ? "" : fmt::format("did you mean \"{}\"? ", near),
      fmt::join(allowed, "\", \"")));
}

template <class Read>
auto read_elements(const ConfigValue& value, const std::string& expected,
                   const Read& read) {
  std::vector<decltype(read(value))> elements;
  const std::size_t count = read_array(value, expected).children.size();
  for (std::size_t i = 0; i < count; ++i)
    elements.push_back(read(value.element(i)));
  return elements;
}

std::vector<double> read_numbers(const ConfigValue& value, const Range& range,
                                 const std::string& expected) {
  return read_elements(value, expected, [&](const ConfigValue& element) {
    return read_number(element, range);
  });
}

std::vector<double> read_numbers(const ConfigValue& value, std::size_t count,
                                 const Range& range) {
  const std::string expected = fmt::format("an array of {} numbers", count);
  std::vector<double> numbers = read_numbers(value, range, expected);
  if (numbers.size() != count)
    value.fail(fmt::format("{} is wrong here; expected {}", text_of(value.node),
                           expected));
  return numbers;
}

}  // namespace

ConfigTable::ConfigTable(std::shared_ptr<DocumentState> document,
                         const ConfigNode& node, std::string path, bool present)
    : document_(std::move(document)),
      node_(&node),
      path_(std::move(path)),
      present_(present) {}

std::string ConfigTable::path_of(std::string_view key) const {
  return joined(path_, key);
}

const ConfigNode* ConfigTable::peek(std::string_view key) const {
  return present_ ? find_child(*node_, key) : nullptr;
}

std::optional<ConfigValue> ConfigTable::find(std::string_view key) const {
  document_->note_known(path_of(key));
  const ConfigNode* node = peek(key);
  if (node == nullptr) return std::nullopt;
  document_->mark_read(*node);
  return ConfigValue{*document_, *node, path_of(key)};
}

// A required key is most often missing because it is misspelt.
void ConfigTable::fail_missing(std::string_view key,
                               const std::string& expected) const {
  std::vector<std::string> unread;
  if (present_) {
    for (const ConfigNode& child : node_->children) {
      if (!child.known && !child.origin) unread.push_back(child.key);
    }
  }
  const std::string near = suggestion(key, unread);
  if (near.empty()) fail(key, "missing; expected " + expected);
  const ConfigNode& child = *find_child(*node_, near);
  fail(key, fmt::format("missing; expected {}; there is a '{}' in line {}",
                        expected, near, child.key_position.line));
}

ConfigValue ConfigTable::require(std::string_view key,
                                 const std::string& expected) const {
  const std::optional<ConfigValue> value = find(key);
  if (!value) fail_missing(key, expected);
  return *value;
}

bool ConfigTable::has(std::string_view key) const {
  document_->note_known(path_of(key));
  return peek(key) != nullptr;
}

bool ConfigTable::holds_number(std::string_view key) const {
  if (!has(key)) return false;
  const ConfigNode::Kind kind = peek(key)->kind;
  return kind == ConfigNode::Kind::kInteger || kind == ConfigNode::Kind::kFloat;
}

double ConfigTable::number(std::string_view key, const Range& range) const {
  return read_number(require(key, text_of(range)), range);
}

double ConfigTable::number_or(std::string_view key, double otherwise,
                              const Range& range) const {
  return optional_number(key, range).value_or(otherwise);
}

std::optional<double> ConfigTable::optional_number(std::string_view key,
                                                   const Range& range) const {
  const std::optional<ConfigValue> value = find(key);
  if (!value) return std::nullopt;
  return read_number(*value, range);
}

long ConfigTable::integer(std::string_view key, long low, long high) const {
  return read_integer(require(key, text_of_integers(low, high)), low, high);
}

long ConfigTable::integer_or(std::string_view key, long otherwise, long low,
                             long high) const {
  const std::optional<ConfigValue> value = find(key);
  return value ? read_integer(*value, low, high) : otherwise;
}

bool ConfigTable::flag(std::string_view key) const {
  return read_flag(require(key, "true or false"));
}

bool ConfigTable::flag_or(std::string_view key, bool otherwise) const {
  const std::optional<ConfigValue> value = find(key);
  return value ? read_flag(*value) : otherwise;
}

std::string ConfigTable::text(std::string_view key) const {
  return read_text(require(key, "a text in quotes"));
}

std::string ConfigTable::text_or(std::string_view key,
                                 std::string_view otherwise) const {
  return optional_text(key).value_or(std::string(otherwise));
}

std::optional<std::string> ConfigTable::optional_text(
    std::string_view key) const {
  const std::optional<ConfigValue> value = find(key);
  if (!value) return std::nullopt;
  return read_text(*value);
}

std::string ConfigTable::choice(std::string_view key,
                                const std::vector<std::string>& allowed) const {
  return read_choice(
      require(key, fmt::format("one of \"{}\"", fmt::join(allowed, "\", \""))),
      allowed);
}

std::string ConfigTable::choice_or(
    std::string_view key, std::string_view otherwise,
    const std::vector<std::string>& allowed) const {
  const std::optional<ConfigValue> value = find(key);
  return value ? read_choice(*value, allowed) : std::string(otherwise);
}

std::vector<double> ConfigTable::numbers(std::string_view key,
                                         const Range& range) const {
  const std::string expected = "an array of numbers";
  return read_numbers(require(key, expected), range, expected);
}

std::vector<double> ConfigTable::numbers(std::string_view key,
                                         std::size_t count,
                                         const Range& range) const {
  return read_numbers(
      require(key, fmt::format("an array of {} numbers", count)), count, range);
}

std::vector<long> ConfigTable::integers(std::string_view key, long low,
                                        long high) const {
  const std::string expected = "an array of integers";
  return read_elements(require(key, expected), expected,
                       [&](const ConfigValue& element) {
                         return read_integer(element, low, high);
                       });
}

std::vector<std::string> ConfigTable::texts(std::string_view key) const {
  const std::string expected = "an array of texts";
  return read_elements(require(key, expected), expected, read_text);
}

std::vector<std::vector<double>> ConfigTable::rows(std::string_view key,
                                                   std::size_t width) const {
  const std::string expected =
      fmt::format("an array of arrays of {} numbers", width);
  return read_elements(require(key, expected), expected,
                       [&](const ConfigValue& element) {
                         return read_numbers(element, width, any());
                       });
}

std::vector<std::string> ConfigTable::keys() const {
  std::vector<std::string> keys;
  if (!present_) return keys;
  for (const ConfigNode& child : node_->children) keys.push_back(child.key);
  return keys;
}

const ConfigNode& ConfigTable::value(std::string_view key) const {
  return require(key, "a value").node;
}

std::vector<ConfigTable> ConfigTable::tables(std::string_view key) const {
  std::vector<ConfigTable> tables;
  const std::optional<ConfigValue> value = find(key);
  if (!value) return tables;
  const std::string expected =
      fmt::format("an array of tables [[{}]]", path_of(key));
  const std::size_t count = read_array(*value, expected).children.size();
  for (std::size_t i = 0; i < count; ++i) {
    const ConfigValue element = value->element(i);
    if (element.node.kind != ConfigNode::Kind::kTable)
      value->fail(fmt::format("{} is wrong here; expected {}",
                              text_of(element.node), expected));
    document_->mark_read(element.node);
    tables.push_back(ConfigTable(document_, element.node, element.path, true));
  }
  return tables;
}

ConfigTable ConfigTable::table(std::string_view key) const {
  std::optional<ConfigTable> table = optional_table(key);
  if (!table) fail_missing(key, fmt::format("a table [{}]", path_of(key)));
  return *std::move(table);
}

std::optional<ConfigTable> ConfigTable::optional_table(
    std::string_view key) const {
  const std::optional<ConfigValue> value = find(key);
  if (!value) return std::nullopt;
  if (value->node.kind != ConfigNode::Kind::kTable) {
    value->fail(fmt::format("{} is wrong here; expected a table",
                            text_of(value->node)));
  }
  return ConfigTable(document_, value->node, value->path, true);
}

ConfigTable ConfigTable::table_or_empty(std::string_view key) const {
  std::optional<ConfigTable> table = optional_table(key);
  if (table) return *std::move(table);
  return ConfigTable(document_, *node_, path_of(key), false);
}

std::string ConfigTable::position(std::string_view key) const {
  const ConfigNode* value = peek(key);
  const ConfigNode& node = value != nullptr ? *value : *node_;
  return document_->place(node, node.position);
}

std::string ConfigTable::place(std::string_view key) const {
  return fmt::format("{}: {}", position(key), path_of(key));
}

std::string ConfigTable::place(std::string_view key, std::size_t index) const {
  const ConfigNode* value = peek(key);
  if (value == nullptr || index >= value->children.size()) return place(key);
  const ConfigNode& element = value->children[index];
  return fmt::format("{}: {}[{}]", document_->place(element, element.position),
                     path_of(key), index);
}

void ConfigTable::fail(std::string_view key, const std::string& message) const {
  const ConfigNode* value = peek(key);
  const ConfigNode& node = value != nullptr ? *value : *node_;
  document_->fail(node, node.position,
                  fmt::format("{}: {}", path_of(key), message));
}

void ConfigTable::fail(std::string_view key, std::size_t index,
                       const std::string& message) const {
  const ConfigNode* value = peek(key);
  if (value == nullptr || index >= value->children.size()) fail(key, message);
  const ConfigNode& element = value->children[index];
  document_->fail(element, element.position,
                  fmt::format("{}[{}]: {}", path_of(key), index, message));
}

}  // namespace beamgyro::internal
