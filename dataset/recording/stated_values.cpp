// SPDX-License-Identifier: MIT
#include "dataset/recording/stated_values.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/config_node.h"
#include "config/document.h"

namespace beamgyro::internal {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

/// Calls `use` with the value of a key. A text that is no TOML, of another
/// program's device, has none.
template <typename Use>
auto with_value(const std::string& text, const std::string& overrides_text,
                std::string_view key, Use use)
    -> decltype(use(std::declval<const ConfigNode&>())) try {
  if (text.empty()) return std::nullopt;
  Overrides overrides(lines_of(overrides_text));
  const ConfigDocument document =
      ConfigDocument::parse(text, "text of the recording", overrides);
  const ConfigNode* value = document.value(key);
  if (value == nullptr) return std::nullopt;
  return use(*value);
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

}  // namespace

std::optional<double> stated_device_number(const Recording& recording,
                                           std::string_view key) {
  return with_value(recording.device_text, recording.overrides_text, key,
                    [](const ConfigNode& value) -> std::optional<double> {
                      if (value.kind == ConfigNode::Kind::kInteger)
                        return static_cast<double>(value.integer);
                      return value.kind == ConfigNode::Kind::kFloat
                                 ? std::optional(value.number)
                                 : std::nullopt;
                    });
}

std::optional<bool> stated_scenario_flag(const Recording& recording,
                                         std::string_view key) {
  return with_value(recording.scenario_text, recording.overrides_text, key,
                    [](const ConfigNode& value) -> std::optional<bool> {
                      return value.kind == ConfigNode::Kind::kFlag
                                 ? std::optional(value.flag)
                                 : std::nullopt;
                    });
}

}  // namespace beamgyro::internal
