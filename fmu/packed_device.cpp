// SPDX-License-Identifier: MIT
#include "fmu/packed_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "config/config_node.h"
#include "config/document_state.h"
#include "fmu/text_digest.h"
#include "sim/device/device_file.h"

namespace beamgyro::internal {
namespace {

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

ConfigDocument document_of(const std::string& text,
                           const std::string& overrides) {
  return ConfigDocument::parse(text, kPackedDevice,
                               Overrides(lines_of(overrides)))
      .settled();
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    throw std::invalid_argument(fmt::format(
        "{}: cannot read; expected a resource of an FMU of beamgyro",
        file.string()));
  return bytes;
}

// FMI wants other names than letters, digits and lines between quotes.
std::string structured(const std::string& part) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           (c >= '0' && c <= '9') || c == '_';
  };
  const bool starts_with_digit = part[0] >= '0' && part[0] <= '9';
  return std::ranges::all_of(part, is_plain) && !starts_with_digit
             ? part
             : fmt::format("'{}'", part);
}

// Returns false for a key that FMI or a dotted name of TOML cannot say.
bool split_key(const ConfigDocument& document, std::string_view key,
               DeviceKey& found) {
  if (const std::size_t bracket = key.find('['); bracket != key.npos) {
    std::size_t index = 0;
    std::from_chars(key.data() + bracket + 1, key.data() + key.size(), index);
    found.index = index;
    key = key.substr(0, bracket);
  }
  const auto is_sayable = [](char c) {
    return c >= ' ' && c <= '~' && c != '\'' && c != '\\';
  };
  if (document.value(key) == nullptr || !std::ranges::all_of(key, is_sayable))
    return false;
  while (!key.empty()) {
    const std::size_t dot = std::min(key.find('.'), key.size());
    if (dot == 0) return false;
    found.path.emplace_back(key.substr(0, dot));
    found.name +=
        (found.name.empty() ? "" : ".") + structured(found.path.back());
    key.remove_prefix(std::min(dot + 1, key.size()));
  }
  if (found.index) found.name += fmt::format("[{}]", *found.index + 1);
  return true;
}

std::vector<DeviceKey> keys_of(const ConfigDocument& document,
                               const std::vector<NumberRead>& numbers) {
  std::vector<DeviceKey> keys;
  for (const NumberRead& number : numbers) {
    DeviceKey key{{}, {}, {}, number.value, number.range, number.whole};
    if (!split_key(document, number.key, key)) continue;
    // A key that is read twice has the range of the second reading.
    const auto same = std::ranges::find(keys, key.name, &DeviceKey::name);
    if (same == keys.end())
      keys.push_back(std::move(key));
    else
      *same = std::move(key);
  }
  return keys;
}

void put_number(const DeviceKey& key, double value, ConfigNode& node) {
  if (key.whole) {
    node.kind = ConfigNode::Kind::kInteger;
    node.integer = static_cast<long>(value);
  } else {
    node.kind = ConfigNode::Kind::kFloat;
    node.number = value;
  }
}

}  // namespace

PackedDevice::PackedDevice(const std::string& text,
                           const std::string& overrides,
                           const std::string& fidelity)
    : document_(document_of(text, overrides)),
      fidelity_(step_fidelity(fidelity)),
      token_(text_digest(text + '\n' + overrides + '\n' + fidelity)) {
  std::vector<NumberRead> numbers;
  document_.collect_numbers(&numbers);
  parameters_ = read_device(document_);
  document_.collect_numbers(nullptr);
  document_.reject_unknown_keys();
  keys_ = keys_of(document_, numbers);
}

PackedDevice PackedDevice::read(const std::filesystem::path& resources) {
  return {bytes_of(resources / kPackedDevice),
          bytes_of(resources / kPackedOverrides),
          bytes_of(resources / kPackedFidelity)};
}

DeviceParameters PackedDevice::with(const std::vector<double>& values) const {
  Overrides changes;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const DeviceKey& key = keys_[i];
    if (values[i] == key.value) continue;
    const std::string dotted = fmt::format("{}", fmt::join(key.path, "."));
    ConfigNode node = *document_.value(dotted);
    if (key.index) {
      // The other elements of the array may have changed as well.
      for (std::size_t k = 0; k < keys_.size(); ++k)
        if (keys_[k].path == key.path)
          put_number(keys_[k], values[k], node.children[*keys_[k].index]);
    } else {
      put_number(key, values[i], node);
    }
    changes.add(key.path, node, "parameters");
  }
  return read_device(document_.with(changes));
}

}  // namespace beamgyro::internal
