// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "config/config_node.h"
#include "config/document_state.h"
#include "config/range.h"

namespace beamgyro::internal {

/// A value of a document, and its dotted key for messages (with [index] inside
/// an array).
struct ConfigValue {
  const DocumentState& document;
  const ConfigNode& node;
  std::string path;

  ConfigValue element(std::size_t index) const;
  /// Throws std::invalid_argument "place: path: message".
  [[noreturn]] void fail(const std::string& message) const;
};

/// Each function throws std::invalid_argument for a value of another type or
/// out of range, and for a number that is not finite.
double read_number(const ConfigValue& value, const Range& range);
long read_integer(const ConfigValue& value, long low, long high);
bool read_flag(const ConfigValue& value);
std::string read_text(const ConfigValue& value);
const ConfigNode& read_array(const ConfigValue& value,
                             const std::string& expected);

std::string text_of_integers(long low, long high);

}  // namespace beamgyro::internal
