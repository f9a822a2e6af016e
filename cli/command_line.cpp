// SPDX-License-Identifier: MIT
#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "cli/terminal.h"
#include "config/suggestion.h"

namespace beamgyro::internal {
namespace {

Action printing(std::string text) {
  return [text = std::move(text)] {
    print_result(text);
    return 0;
  };
}

}  // namespace

struct Command::Option {
  OptionText text;
  Count count;
  Take take;
  Words given = {};          // nothing of a flag
  ExpectedKinds files = {};  // that these name

  bool is_called(std::string_view name) const {
    return text.is_option() &&
           (name == text.long_name() || name == text.names.substr(0, 2));
  }
};

Command::Command(CLI::App& app, HelpOfCommand help)
    : app_(&app), help_(std::move(help)) {}

Command::~Command() = default;

void Command::add(const OptionText& text, Count count, Take take, int most) {
  help_.lines.push_back(text);
  help_.lines.back().group = !text.is_option() ? "Arguments"
                             : !group_.empty() ? group_
                                               : "Options";
  options_.push_back(
      std::make_unique<Option>(Option{text, count, std::move(take)}));
  if (count == Count::kNone) return;
  CLI::Option* const added = app_->add_option(
      text.is_option() ? text.names
                       : fmt::format("argument{}", options_.size()),
      options_.back()->given);
  if (count == Count::kOne) added->expected(1);
  if (count != Count::kList) added->allow_extra_args(false);
  if (most > 0) added->expected(1, most);
}

void Command::choice(const OptionText& text, std::string& value,
                     const std::vector<std::string>& allowed) {
  add(text, Count::kOne, [&value, allowed, text](const Words& words) {
    value = one_of(text.long_name(), words[0], allowed);
  });
}

void Command::choices(const OptionText& text, std::vector<std::string>& values,
                      const std::vector<std::string>& allowed) {
  add(text, Count::kRepeated, [&values, allowed, text](const Words& words) {
    values.clear();
    for (const std::string& word : words)
      values.push_back(one_of(text.long_name(), word, allowed));
  });
  app_->get_option(text.long_name())->delimiter(',');
}

void Command::seed(const OptionText& text,
                   std::optional<std::uint64_t>& value) {
  add(text, Count::kOne, [&value, text](const Words& words) {
    value = seed_or_random(text.long_name(), words[0]);
  });
}

void Command::flag(const OptionText& text, bool& value) {
  add(text, Count::kNone, {});
  app_->add_flag(text.names, value);
}

void Command::reads(const ExpectedKinds& expected) {
  options_.back()->files = expected;
}

void Command::exclude(const std::string& name,
                      const std::vector<std::string>& others) {
  for (const std::string& other : others)
    app_->get_option(name)->excludes(app_->get_option(other));
}

void Command::example(const std::string& line, const std::string& what) {
  help_.examples.push_back({line, what});
}

const Command::Option* Command::find(std::string_view name) const {
  const auto found = std::ranges::find_if(
      options_, [&](const auto& option) { return option->is_called(name); });
  return found == options_.end() ? nullptr : found->get();
}

void Command::require_all() const {
  for (const auto& option : options_)
    if (option->text.is_required() && option->given.empty())
      throw std::invalid_argument(fmt::format("{} is missing; expected {}",
                                              option->text.long_name(),
                                              usage(help_)));
}

void Command::take_all() const {
  for (const auto& option : options_)
    if (!option->given.empty()) option->take(option->given);
}

int Command::carry_out() const {
  try {
    return action_();
  } catch (const std::invalid_argument&) {
    for (const auto& option : options_)
      for (const std::string& file : option->given)
        if (!option->files.kinds.empty()) require_kind(file, option->files);
    throw;
  }
}

struct CommandLine::Words {
  const Command* command = nullptr;
  std::vector<std::string> plain;  // neither options nor their values
  std::set<const Command::Option*> given_once;  // of those with one value
  bool asks_help = false, asks_version = false;
};

CommandLine::CommandLine(const std::string& description, std::string version)
    : description_(description),
      version_(std::move(version)),
      app_(std::make_unique<CLI::App>(description, "beamgyro")) {
  app_->set_help_flag();  // help is ours
  app_->fallthrough();
  common_ = std::make_unique<Command>(*app_, HelpOfCommand{});
  common_->group("Options of every command");
  common_->flag(
      {"-q,--quiet", "", "Prints results and errors, no notes, no progress"},
      quiet_);
  common_->flag({"-h,--help", "", "Prints this help"}, asks_help_);
  common_->flag({"--version", "", "Prints the version and those of libraries"},
                asks_version_);
}

CommandLine::~CommandLine() = default;

Command& CommandLine::add(const std::string& name, const std::string& group,
                          const std::string& summary) {
  CLI::App* const app = app_->add_subcommand(name);
  commands_.push_back(
      std::make_unique<Command>(*app, HelpOfCommand{name, group, summary}));
  return *commands_.back();
}

Command& CommandLine::command(const std::string& name) const {
  std::vector<std::string> names = {"help"};
  for (const auto& command : commands_) {
    if (command->help_.name == name) return *command;
    names.push_back(command->help_.name);
  }
  const std::string meant = suggestion(name, names);
  throw std::invalid_argument(
      fmt::format("unknown command \"{}\"; {}", name,
                  meant.empty() ? "see beamgyro --help"
                                : fmt::format("did you mean \"{}\"?", meant)));
}

void CommandLine::fail_option(const std::string& name,
                              const Command* command) const {
  std::vector<std::string> names;
  for (const Command* source :
       {command, static_cast<const Command*>(common_.get())}) {
    if (source == nullptr) continue;
    for (const auto& option : source->options_)
      if (option->text.is_option())
        names.push_back(option->text.long_name().substr(2));
  }
  const std::string meant = suggestion(
      name.substr(std::min(name.find_first_not_of('-'), name.size())), names);
  throw std::invalid_argument(fmt::format(
      "unknown option \"{}\"; {}", name,
      meant.empty() ? fmt::format("see beamgyro{} --help",
                                  command ? " " + command->help_.name : "")
                    : fmt::format("did you mean \"--{}\"?", meant)));
}

const Command::Option* CommandLine::find_option(std::string_view name,
                                                const Command* command) const {
  const Command::Option* option = command ? command->find(name) : nullptr;
  return option ? option : common_->find(name);
}

// Returns the index of the last word that belongs to the option at `at`.
std::size_t CommandLine::look_at_option(const std::vector<std::string>& words,
                                        std::size_t at, Words& found) const {
  const std::string& word = words[at];
  const bool is_long = word.starts_with("--");
  const std::string until_equals = word.substr(0, word.find('='));
  const std::string name = is_long ? until_equals : word.substr(0, 2);
  const Command::Option* option = find_option(name, found.command);
  // "-output" would be "-o" with the value "utput".
  if (option == nullptr ||
      (!is_long && find_option("-" + until_equals, found.command)))
    fail_option(is_long ? name : until_equals, found.command);
  const bool has_equals = word.size() > name.size() && word[name.size()] == '=';
  if (option->count == Command::Count::kNone) {
    if (has_equals)
      throw std::invalid_argument(fmt::format("{} takes no value", name));
    found.asks_help |= option->is_called("--help");
    found.asks_version |= option->is_called("--version");
    return at;
  }
  if (option->count == Command::Count::kOne &&
      !found.given_once.insert(option).second)
    throw std::invalid_argument(
        fmt::format("{} is given twice; expected one value", name));
  if (!is_long && has_equals)
    throw std::invalid_argument(
        fmt::format("\"{}\": a short option takes no \"=\"; expected {} {}",
                    word, name, word.substr(name.size() + 1)));
  if (word.size() > name.size() + (has_equals ? 1 : 0))
    return at;  // --name=value, -nvalue
  if (has_equals || at + 1 == words.size() ||
      find_option(words[at + 1].substr(0, words[at + 1].find('=')),
                  found.command))
    throw std::invalid_argument(fmt::format("{} has no value; expected {} {}",
                                            name, name, option->text.value));
  return at + 1;
}

// CLI11 alone would name unknown options after missing ones, and without a
// suggestion.
CommandLine::Words CommandLine::look_at(
    const std::vector<std::string>& words) const {
  Words found;
  for (std::size_t at = 0; at < words.size(); ++at) {
    const std::string& word = words[at];
    if (word == "--") break;
    if (word.size() > 1 && word.starts_with('-')) {
      at = look_at_option(words, at, found);
      continue;
    }
    if (found.plain.empty() && word != "help") found.command = &command(word);
    found.plain.push_back(word);
  }
  return found;
}

std::string CommandLine::overview() const {
  std::vector<HelpOfCommand> commands;
  for (const auto& command : commands_) commands.push_back(command->help_);
  return overview_text(description_, commands, common_->help_.lines);
}

// The last word is the command that the help is about.
Action CommandLine::help(const std::vector<std::string>& words) const {
  std::string text =
      words.empty() || words.back() == "help"
          ? overview()
          : help_text(command(words.back()).help_, common_->help_.lines);
  return printing(std::move(text));
}

// "-out f" is "-o ut" and a word too many.
std::string CommandLine::run_on_advice(const std::vector<std::string>& words,
                                       const Command& command,
                                       const std::string& left) const {
  const auto found = std::ranges::find(words, left);
  if (found == words.begin() || found == words.end()) return "";
  const std::string& before = *(found - 1);
  if (before.size() < 3 || before[0] != '-' || before[1] == '-') return "";
  const Command::Option* const option =
      find_option(before.substr(0, 2), &command);
  if (option == nullptr || option->count == Command::Count::kNone) return "";
  return fmt::format("\"{}\" is {} with the value \"{}\"; expected {} {}",
                     before, before.substr(0, 2), before.substr(2),
                     before.substr(0, 2), left);
}

void CommandLine::split(const Command& command,
                        std::vector<std::string> words) {
  const std::vector<std::string> given = words;
  try {
    std::ranges::reverse(words);  // the order in which CLI11 takes them
    app_->parse(words);
  } catch (const CLI::ExtrasError&) {
    const std::string left = app_->remaining(true).front();
    const std::string advice = run_on_advice(given, command, left);
    throw std::invalid_argument(
        advice.empty() ? fmt::format("unexpected \"{}\"; expected {}", left,
                                     usage(command.help_))
                       : advice);
  } catch (const CLI::ArgumentMismatch&) {
    throw std::invalid_argument(
        fmt::format("too many words; expected {}", usage(command.help_)));
  } catch (const CLI::ParseError& error) {
    const std::string what = error.what();
    throw std::invalid_argument(what.substr(0, what.find('\n')));
  }
}

Action CommandLine::parse(const std::vector<std::string>& words) {
  const Words found = look_at(words);
  if (found.asks_version) return printing(version_ + "\n");
  if (!found.plain.empty() && found.plain[0] == "help")
    return help({found.plain.begin() + 1, found.plain.end()});
  if (found.asks_help)
    return help(found.command
                    ? std::vector<std::string>{found.command->help_.name}
                    : std::vector<std::string>{});
  if (found.command == nullptr)
    throw std::invalid_argument("no command is given; see beamgyro --help");
  split(*found.command, words);
  found.command->require_all();
  found.command->take_all();
  return [command = found.command] { return command->carry_out(); };
}

}  // namespace beamgyro::internal
