// SPDX-License-Identifier: MIT
#include "config/overrides.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/document_state.h"
#include "config/option_message.h"
#include "config/suggestion.h"
#include "config/toml_parser.h"

namespace beamgyro::internal {
namespace {

[[noreturn]] void reject(std::string_view argument,
                         const std::string& message) {
  throw option_error("{} {}: {}", NamedOption{"set"}, printable(argument),
                     message);
}

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         (c >= '0' && c <= '9') || c == '_' || c == '-';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::vector<std::string> split_key(std::string_view key,
                                   std::string_view argument) {
  constexpr std::size_t kDeepest = 16;
  if (key.empty()) reject(argument, "the key before '=' is missing");
  std::vector<std::string> path(1);
  for (const char c : key) {
    if (c == '.') {
      path.emplace_back();
    } else if (is_bare(c)) {
      path.back() += c;
    } else {
      reject(argument,
             fmt::format("'{}' is not a key; expected letters, digits, '_' "
                         "and '-' joined by dots, such as beam.length_m",
                         printable(key)));
    }
  }
  if (std::any_of(path.begin(), path.end(),
                  [](const std::string& part) { return part.empty(); })) {
    reject(argument, fmt::format("the key '{}' has an empty part beside a dot",
                                 printable(key)));
  }
  if (path.size() > kDeepest) reject(argument, "the key has too many parts");
  return path;
}

/// Returns a suggestion in place of a value that is not TOML.
std::string override_advice(std::string_view key, std::string_view value) {
  std::string lower(value);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (lower == "true" || lower == "false")
    return fmt::format("write {}={}", key, lower);
  const bool word = std::all_of(value.begin(), value.end(), [](char c) {
    return is_bare(c) || c == '.' || c == '/' || c == ' ' || c == '+';
  });
  const std::size_t letter = value.find_first_not_of("+-.0123456789eE");
  if (word && letter != value.npos && letter > 0)
    return fmt::format(
        "expected a number alone, or a text in quotes; the name of a key ends "
        "in its unit");
  if (word && letter != value.npos)
    return fmt::format("a text needs quotes: {}=\"{}\"", key, value);
  return "expected a TOML value after '='";
}

ConfigNode parse_value(std::string_view key, std::string_view value,
                       std::string_view argument) {
  if (value.empty())
    reject(argument, "no value after '='; expected one in TOML syntax");
  ConfigNode parsed;
  std::string problem;
  try {
    parsed = parse_toml(fmt::format("v = {}", value));
  } catch (const TomlError& error) {
    problem = error.what();
  }
  if (problem.empty()) return std::move(parsed.children.front());
  const std::string shown = printable(value);
  const std::string help = override_advice(key, shown);
  reject(argument,
         help.starts_with("expected")
             ? fmt::format("'{}' is not TOML ({}); {}", shown, problem, help)
             : fmt::format("'{}' is not TOML; {}", shown, help));
}

Override parse_override(const std::string& argument) {
  if (std::any_of(argument.begin(), argument.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && c != '\t';
      })) {
    reject(argument, "an override is one line without control characters");
  }
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) {
    reject(argument,
           "no '=' in it; expected KEY=VALUE such as "
           "beam.length_m=0.038");
  }
  const std::string_view text = argument;
  const std::string_view key = trimmed(text.substr(0, equals));
  const std::string_view value = trimmed(text.substr(equals + 1));
  Override set{argument, split_key(key, argument), {}, {}};
  set.value = parse_value(key, value, argument);
  return set;
}

bool begins_with(const std::vector<std::string>& path,
                 const std::vector<std::string>& start) {
  return start.size() <= path.size() &&
         std::equal(start.begin(), start.end(), path.begin());
}

void check_against_earlier(const Override& set, const Override& earlier) {
  if (set.path == earlier.path) {
    reject(set.argument, fmt::format("the key was set before, by {}",
                                     printable(earlier.argument)));
  }
  if (begins_with(earlier.path, set.path)) {
    reject(set.argument,
           fmt::format("would replace the earlier {}; give the whole "
                       "table first",
                       printable(earlier.argument)));
  }
}

void set_origin(ConfigNode& node, std::size_t origin) {
  node.origin = origin;
  for (ConfigNode& child : node.children) set_origin(child, origin);
}

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('.') + 1);  // npos + 1 is 0
}

// Keys that hold values, of all that are known: not the tables.
std::vector<std::string> keys_of_values(const std::vector<std::string>& known) {
  std::vector<std::string> keys;
  for (const std::string& key : known)
    if (std::ranges::none_of(known, [&](const std::string& other) {
          return other.starts_with(key + ".");
        }))
      keys.push_back(key);
  return keys;
}

// What could be meant by a key that no file has: its name in another table,
// a key spelled like it, or the keys of its table.
std::string key_advice(const std::vector<std::string>& path,
                       const std::vector<std::string>& known) {
  const std::vector<std::string> keys = keys_of_values(known);
  std::vector<std::string> same_name, same_table;
  const std::string key = fmt::format("{}", fmt::join(path, "."));
  const std::string table = key.substr(0, key.find('.')) + ".";
  for (const std::string& one : keys) {
    if (last_part(one) == path.back()) same_name.push_back(one);
    if (path.size() > 1 && one.starts_with(table))
      same_table.push_back(one.substr(table.size()));
  }
  constexpr std::size_t kMostNames = 4;
  if (path.back().size() > 1 && !same_name.empty() &&
      same_name.size() <= kMostNames)
    return fmt::format("; did you mean '{}'?", fmt::join(same_name, "' or '"));
  if (same_table.empty()) {
    const std::string near = suggestion(key, keys);
    if (!near.empty()) return fmt::format("; did you mean '{}'?", near);
  } else {
    const std::string near = suggestion(key.substr(table.size()), same_table);
    if (!near.empty())
      return fmt::format("; did you mean '{}{}'?", table, near);
    return fmt::format("; '{}' has {}", table.substr(0, table.size() - 1),
                       fmt::join(same_table, ", "));
  }
  return "; expected a key of the scenario or the device";
}

}  // namespace

void reject_override(const std::string& argument, const std::string& message) {
  reject(argument, message);
}

void require_override_key(std::string_view key) { split_key(key, key); }

std::string_view key_of_override(std::string_view text) {
  return trimmed(text.substr(0, text.find('=')));
}

std::vector<std::string> merged_overrides(
    std::vector<std::string> first, const std::vector<std::string>& later) {
  std::erase_if(first, [&](const std::string& text) {
    return std::ranges::count(later, key_of_override(text), key_of_override) >
           0;
  });
  first.insert(first.end(), later.begin(), later.end());
  return first;
}

void insert_override(const Override& set, std::size_t origin,
                     const std::string& document, ConfigNode& root) {
  ConfigNode* table = &root;
  for (std::size_t i = 0;; ++i) {
    ConfigNode* child = find_child(*table, set.path[i]);
    const bool last = i + 1 == set.path.size();
    if (child == nullptr) {
      child = &table->children.emplace_back();
      child->key = set.path[i];
      child->bridge = !last;
    } else if (!last && child->kind != ConfigNode::Kind::kTable) {
      reject(set.argument, fmt::format("'{}' is {} in {}, not a table",
                                       set.path[i], text_of(*child), document));
    }
    if (last) {
      const ConfigNode replaced = std::move(*child);
      *child = set.value;
      child->key = set.path[i];
      child->key_position = replaced.key_position;
      set_origin(*child, origin);
      return;
    }
    table = child;
  }
}

Overrides::Overrides() : state_(std::make_shared<OverrideSet>()) {}

Overrides::Overrides(const std::vector<std::string>& arguments) : Overrides() {
  ConfigNode together;  // finds a path that runs through an earlier value
  for (const std::string& argument : arguments) {
    Override set = parse_override(argument);
    for (const Override& earlier : state_->overrides)
      check_against_earlier(set, earlier);
    insert_override(set, state_->overrides.size(), "an earlier one", together);
    state_->overrides.push_back(std::move(set));
  }
}

void Overrides::add(const std::vector<std::string>& path,
                    const ConfigNode& value, const std::string& place) {
  const std::string argument =
      fmt::format("{}={}", fmt::join(path, "."), toml_text(value));
  state_->overrides.push_back(
      {argument, path, value,
       place.empty() ? "--set " + printable(argument) : place});
}

bool Overrides::all_used() const {
  return std::all_of(state_->overrides.begin(), state_->overrides.end(),
                     [](const Override& set) { return set.used; });
}

std::vector<std::string> Overrides::shared_or_unused() const {
  std::vector<std::string> arguments;
  for (const Override& set : state_->overrides)
    if (!set.used || set.value.kind == ConfigNode::Kind::kTable)
      arguments.push_back(set.argument);
  return arguments;
}

std::vector<std::string> Overrides::known_keys() const {
  return {state_->known_keys.begin(), state_->known_keys.end()};
}

void Overrides::check_all_used() const {
  const std::vector<std::string> known = known_keys();
  for (const Override& set : state_->overrides) {
    if (set.used) continue;
    const std::string key = fmt::format("{}", fmt::join(set.path, "."));
    if (state_->known_keys.contains(key)) {
      reject(set.argument, fmt::format("'{}' is not used together with the "
                                       "other keys given",
                                       key));
    }
    reject(set.argument, fmt::format("no file of this command has a key '{}'{}",
                                     key, key_advice(set.path, known)));
  }
}

std::string Overrides::text() const {
  std::string lines;
  for (const Override& set : state_->overrides) lines += set.argument + '\n';
  return lines;
}

}  // namespace beamgyro::internal
