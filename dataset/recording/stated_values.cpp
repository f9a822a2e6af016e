// SPDX-License-Identifier: MIT
#include "dataset/recording/stated_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
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

/// Documents of the texts that were asked last, each parsed once. A text that
/// is no TOML, of another program's device, has none.
class ParsedTexts {
 public:
  using Document = std::shared_ptr<const ConfigDocument>;

  Document of(const std::string& text, const std::string& overrides_text) {
    const std::lock_guard lock(mutex_);
    const auto key = std::pair(text, overrides_text);
    if (const auto found = documents_.find(key); found != documents_.end())
      return found->second;
    if (documents_.size() >= kMostTexts) documents_.clear();
    return documents_[key] = parsed(text, overrides_text);
  }

 private:
  static constexpr std::size_t kMostTexts = 64;

  static Document parsed(const std::string& text,
                         const std::string& overrides_text) try {
    Overrides overrides(lines_of(overrides_text));
    return std::make_shared<const ConfigDocument>(
        ConfigDocument::parse(text, "text of the recording", overrides));
  } catch (const std::invalid_argument&) {
    return nullptr;
  }

  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Document> documents_;
};

ParsedTexts& texts() {
  static ParsedTexts only;
  return only;
}

/// Calls `use` with the value of a key.
template <typename Use>
auto with_value(const std::string& text, const std::string& overrides_text,
                std::string_view key, Use use)
    -> decltype(use(std::declval<const ConfigNode&>())) {
  if (text.empty()) return std::nullopt;
  const ParsedTexts::Document document = texts().of(text, overrides_text);
  const ConfigNode* value = document ? document->value(key) : nullptr;
  if (value == nullptr) return std::nullopt;
  return use(*value);
}

bool has_table(const std::string& text, const std::string& overrides_text,
               std::string_view name) {
  return with_value(text, overrides_text, name,
                    [](const ConfigNode& value) -> std::optional<bool> {
                      return value.kind == ConfigNode::Kind::kTable;
                    })
      .value_or(false);
}

std::optional<double> number_of(const std::string& text,
                                const std::string& overrides_text,
                                std::string_view key) {
  return with_value(text, overrides_text, key,
                    [](const ConfigNode& value) -> std::optional<double> {
                      if (value.kind == ConfigNode::Kind::kInteger)
                        return static_cast<double>(value.integer);
                      return value.kind == ConfigNode::Kind::kFloat
                                 ? std::optional(value.number)
                                 : std::nullopt;
                    });
}

}  // namespace

bool states_device_table(const Recording& recording, std::string_view name) {
  return has_table(recording.device_text, recording.overrides_text, name);
}

std::string stated_device(const Recording& recording) {
  constexpr std::string_view kTables[] = {"beam",
                                          "patches",
                                          "bond",
                                          "mount",
                                          "air",
                                          "drive",
                                          "readout",
                                          "thermal",
                                          "noise",
                                          "memory",
                                          "temperature_sensor",
                                          "loop_channels",
                                          "spurious_mode"};
  std::string text;
  for (const std::string_view table : kTables)
    text +=
        with_value(recording.device_text, recording.overrides_text, table,
                   [&](ConfigNode node) -> std::optional<std::string> {
                     std::erase_if(node.children, [&](const auto& child) {
                       return table == "noise" && child.key == "enabled";
                     });
                     return fmt::format("{} = {}\n", table, toml_text(node));
                   })
            .value_or("");
  return text.empty() ? recording.device_text : text;
}

bool states_scenario_table(const Recording& recording, std::string_view name) {
  return has_table(recording.scenario_text, recording.overrides_text, name);
}

std::optional<double> stated_device_number(const Recording& recording,
                                           std::string_view key) {
  return number_of(recording.device_text, recording.overrides_text, key);
}

std::optional<double> stated_scenario_number(const Recording& recording,
                                             std::string_view key) {
  return number_of(recording.scenario_text, recording.overrides_text, key);
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
