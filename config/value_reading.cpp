// SPDX-License-Identifier: MIT
#include "config/value_reading.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

namespace beamgyro::internal {
namespace {

// Units that are typed for those in the names of keys.
struct TypedUnit {
  std::string_view key_end, typed, unit;
  double factor;
};
constexpr TypedUnit kTypedUnits[] = {
    {"_m", "mm", "m", 1e-3},
    {"_m", "um", "m", 1e-6},
    {"_Pa", "GPa", "Pa", 1e9},
    {"_Pa", "MPa", "Pa", 1e6},
    {"_kg_per_m3", "g/cm3", "kg/m3", 1e3},
    {"_J_per_mol", "kJ/mol", "J/mol", 1e3},
    {"_F", "pF", "F", 1e-12},
    {"_C_per_N", "pC/N", "C/N", 1e-12},
};

/// Returns "; 40 mm is 0.04 m" for a number that would be in range in another
/// unit, or an empty text.
std::string other_unit(std::string_view path, double number,
                       const Range& range) {
  const std::string_view key = path.substr(0, path.find('['));
  for (const TypedUnit& unit : kTypedUnits) {
    const double meant = number * unit.factor;
    if (key.ends_with(unit.key_end) && range.contains(meant))
      return fmt::format("; {:g} {} is {:g} {}", number, unit.typed, meant,
                         unit.unit);
  }
  return "";
}

[[noreturn]] void wrong_type(const ConfigValue& value,
                             const std::string& expected) {
  value.fail(fmt::format("{} is wrong here; expected {}", text_of(value.node),
                         expected));
}

}  // namespace

ConfigValue ConfigValue::element(std::size_t index) const {
  return {document, node.children[index], fmt::format("{}[{}]", path, index)};
}

void ConfigValue::fail(const std::string& message) const {
  document.fail(node, node.position, fmt::format("{}: {}", path, message));
}

double read_number(const ConfigValue& value, const Range& range) {
  const ConfigNode& node = value.node;
  double number = node.number;
  if (node.kind == ConfigNode::Kind::kInteger) {
    number = static_cast<double>(node.integer);
  } else if (node.kind != ConfigNode::Kind::kFloat) {
    wrong_type(value, text_of(range));
  }
  if (!std::isfinite(number)) {
    value.fail(
        fmt::format("{} is not finite; expected {}", number, text_of(range)));
  }
  if (!range.contains(number)) {
    value.fail(fmt::format("{} is out of range; expected {}{}", text_of(node),
                           text_of(range),
                           other_unit(value.path, number, range)));
  }
  value.document.note_number(value.path, number, range, false);
  return number;
}

std::string text_of_integers(long low, long high) {
  const bool below = low != std::numeric_limits<long>::min();
  const bool above = high != std::numeric_limits<long>::max();
  if (below && above) return fmt::format("an integer in [{}, {}]", low, high);
  if (below) return fmt::format("an integer >= {}", low);
  if (above) return fmt::format("an integer <= {}", high);
  return "an integer";
}

long read_integer(const ConfigValue& value, long low, long high) {
  const ConfigNode& node = value.node;
  if (node.kind != ConfigNode::Kind::kInteger)
    wrong_type(value, text_of_integers(low, high));
  if (node.integer < low || node.integer > high) {
    value.fail(fmt::format("{} is out of range; expected {}", node.integer,
                           text_of_integers(low, high)));
  }
  value.document.note_number(
      value.path, static_cast<double>(node.integer),
      between(static_cast<double>(low), static_cast<double>(high)), true);
  return node.integer;
}

bool read_flag(const ConfigValue& value) {
  if (value.node.kind != ConfigNode::Kind::kFlag)
    wrong_type(value, "true or false");
  return value.node.flag;
}

std::string read_text(const ConfigValue& value) {
  if (value.node.kind != ConfigNode::Kind::kText)
    wrong_type(value, "a text in quotes");
  if (value.node.text.find('\0') != std::string::npos)
    value.fail(text_of(value.node) + " holds a NUL character; remove it");
  return value.node.text;
}

const ConfigNode& read_array(const ConfigValue& value,
                             const std::string& expected) {
  if (value.node.kind != ConfigNode::Kind::kArray) wrong_type(value, expected);
  return value.node;
}

}  // namespace beamgyro::internal
