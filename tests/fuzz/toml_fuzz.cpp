// SPDX-License-Identifier: MIT
// A TOML file and, one a line after "=====", KEY=VALUE of --set.
#include <string>
#include <vector>

#include "config/config_node.h"
#include "config/document.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace beamgyro::internal;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

// Reads every value by its own kind, as a whole document is read.
void read_all(const ConfigTable& table, int depth = 0) {
  for (const std::string& key : table.keys()) {
    const ConfigNode& value = table.value(key);
    static_cast<void>(text_of(value));
    static_cast<void>(toml_text(value));
    static_cast<void>(table.place(key));
    if (value.kind == ConfigNode::Kind::kTable && depth < 1000)
      read_all(table.table(key), depth + 1);
    if (value.kind == ConfigNode::Kind::kText)
      static_cast<void>(table.text(key));
    if (table.holds_number(key)) static_cast<void>(table.number(key));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const auto [text, sets] = split(text_of(data, size));
  accept_or_reject([&, text = text, sets = sets] {
    Overrides overrides(lines_of(sets));
    const ConfigDocument document =
        ConfigDocument::parse(text, "fuzz.toml", overrides);
    read_all(document.root());
    document.reject_unknown_keys();
    overrides.check_all_used();
  });
  return 0;
}
