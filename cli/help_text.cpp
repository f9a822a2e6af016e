// SPDX-License-Identifier: MIT
#include "cli/help_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

constexpr std::size_t kHelpWidth = 80, kHelpColumn = 26;  // [characters]

/// Appends the words of `text` from column `at` of the present line on, and
/// begins each further line at column `indent`.
void wrap(std::string& page, std::string_view text, std::size_t indent,
          std::size_t at) {
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    if (!first && at + 1 + word.size() > kHelpWidth) {
      page += '\n' + std::string(indent, ' ');
      at = indent;
    } else if (!first) {
      page += ' ';
      ++at;
    }
    page += word;
    at += word.size();
    first = false;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  page += '\n';
}

void append_line_of(std::string& page, const std::string& left,
                    std::string_view right) {
  page += "  " + left;
  std::size_t at = 2 + left.size();
  if (at + 2 > kHelpColumn) {
    page += '\n';
    at = 0;
  }
  page += std::string(kHelpColumn - at, ' ');
  wrap(page, right, kHelpColumn, kHelpColumn);
}

std::string left_of(const OptionText& text) {
  std::string left = text.names;
  if (const std::size_t comma = left.find(','); comma != left.npos)
    left.replace(comma, 1, ", ");
  return text.is_option() && !text.value.empty() ? left + " " + text.value
                                                 : left;
}

std::string right_of(const OptionText& text) {
  std::string right = text.help + ".";
  if (text.is_option() && text.is_required()) right += " Required.";
  if (!text.otherwise.empty()) right += " Default: " + text.otherwise + ".";
  return right;
}

// Groups stand in the order in which they appear first.
void append_groups(std::string& page, const std::vector<OptionText>& lines) {
  std::vector<std::string> groups;
  for (const OptionText& line : lines)
    if (std::ranges::find(groups, line.group) == groups.end())
      groups.push_back(line.group);
  for (const std::string& group : groups) {
    page += "\n" + group + ":\n";
    for (const OptionText& line : lines)
      if (line.group == group)
        append_line_of(page, left_of(line), right_of(line));
  }
}

/// Breaks a command of the shell where it is wider than the help.
std::string wrapped_command(std::string line) {
  constexpr std::size_t kLongest = kHelpWidth - 4;
  std::size_t begin = 0;
  while (line.size() - begin > kLongest) {
    const std::size_t space = line.rfind(" -", begin + kLongest - 2);
    if (space == line.npos || space <= begin) break;
    line.replace(space, 1, " \\\n      ");
    begin = space + 3;
  }
  return line;
}

}  // namespace

const std::string& OptionText::named(const std::string& word) const {
  if (word.empty())
    throw std::invalid_argument(fmt::format("{} \"\": is empty; expected {}",
                                            long_name(),
                                            is_option() ? value : "a name"));
  return word;
}

std::string usage(const HelpOfCommand& command) {
  std::string text = "beamgyro " + command.name;
  for (const OptionText& line : command.lines) {
    if (!line.is_required()) continue;
    text += ' ' + line.names.substr(0, line.names.find(','));
    if (line.is_option()) text += ' ' + line.value;
  }
  return text;
}

std::string help_text(const HelpOfCommand& command,
                      const std::vector<OptionText>& common) {
  std::string page;
  wrap(page, command.summary + ".", 0, 0);
  page += "\nUsage: ";
  wrap(page, usage(command) + " [OPTIONS]", 9, 7);
  append_groups(page, command.lines);
  append_groups(page, common);
  page += "\nExamples:\n";
  for (const CommandExample& example : command.examples) {
    page += "  " + wrapped_command(example.line) + "\n      ";
    wrap(page, example.what + ".", 6, 6);
  }
  return page;
}

std::string overview_text(std::string_view description,
                          const std::vector<HelpOfCommand>& commands,
                          const std::vector<OptionText>& common) {
  std::string page;
  wrap(page, description, 0, 0);
  page += "\nUsage: beamgyro COMMAND [ARGUMENTS] [OPTIONS]\n";
  std::string group;
  for (const HelpOfCommand& command : commands) {
    if (command.group != group)
      fmt::format_to(std::back_inserter(page), "\n{}:\n", command.group);
    group = command.group;
    append_line_of(page, command.name, command.summary + ".");
  }
  append_groups(page, common);
  page +=
      "\nExamples:\n"
      "  beamgyro help run\n"
      "      Prints the options of a command, as \"beamgyro run --help\" "
      "does.\n"
      "  beamgyro run scenarios/warm_up.toml -o warm_up.h5\n"
      "      Simulates the first hour after power-on.\n";
  return page;
}

}  // namespace beamgyro::internal
