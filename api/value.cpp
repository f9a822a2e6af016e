// SPDX-License-Identifier: MIT
#include "include/beamgyro/value.h"

#include <fmt/format.h>

#include "config/config_node.h"
#include "config/overrides.h"

namespace beamgyro {

Value::Value(double number)
    : toml_(internal::toml_text(internal::number_node(number))) {}

std::string Value::quoted(std::string_view text) {
  internal::ConfigNode node;
  node.kind = internal::ConfigNode::Kind::kText;
  node.text = text;
  return internal::toml_text(node);
}

std::string override_of(std::string_view key, const Value& value) {
  internal::require_override_key(key);
  return fmt::format("{}={}", key, value.toml());
}

}  // namespace beamgyro
