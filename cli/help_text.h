// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// How an option or an argument stands in the help.
struct OptionText {
  std::string names;           // "-o,--output"; of an argument "SCENARIO.toml"
  std::string value = {};      // stands for the value; empty for a flag
  std::string help = {};       // a sentence without its full stop
  std::string otherwise = {};  // the default; empty: required, or a flag
  std::string group = {};      // heading above it

  bool is_option() const { return names.starts_with('-'); }
  std::string long_name() const { return names.substr(names.find(',') + 1); }
  bool is_required() const {
    return otherwise.empty() && (!is_option() || !value.empty());
  }
  /// Returns `word`, a value. Throws std::invalid_argument for an empty one: a
  /// name that a script left empty is no name.
  const std::string& named(const std::string& word) const;
};

struct CommandExample {
  std::string line, what;
};

struct HelpOfCommand {
  std::string name, group, summary;
  std::vector<OptionText> lines = {};
  std::vector<CommandExample> examples = {};
};

/// Returns "beamgyro run SCENARIO.toml -o FILE": what must be given.
std::string usage(const HelpOfCommand& command);

/// Returns the help of a command, lines of at most 80 columns. `common` has the
/// options of every command.
std::string help_text(const HelpOfCommand& command,
                      const std::vector<OptionText>& common);

/// Returns the list of all commands, in groups.
std::string overview_text(std::string_view description,
                          const std::vector<HelpOfCommand>& commands,
                          const std::vector<OptionText>& common);

}  // namespace beamgyro::internal
