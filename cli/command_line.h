// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/file_kind.h"
#include "cli/help_text.h"
#include "config/range.h"

namespace CLI {  // NOLINT(readability-identifier-naming): as CLI11 has it
class App;
}

namespace beamgyro::internal {

/// Carries out a parsed command and returns the exit status.
using Action = std::function<int()>;

struct IntegerRange {
  long low = 0, high = std::numeric_limits<long>::max();
};

/// A command of the program with its arguments and options. Each function below
/// adds one; the variable gets its value when the command line is parsed, and
/// must live until then. A value that cannot be read throws
/// std::invalid_argument "--option VALUE: what is wrong; what would be right".
class Command {
 public:
  Command(CLI::App& app, HelpOfCommand help);
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// What follows stands under this heading of the help.
  void group(std::string heading) { group_ = std::move(heading); }

  /// One word, or one to `most` words, that belong to no option.
  void argument(const OptionText& text, std::string& value);
  void arguments(const OptionText& text, std::vector<std::string>& values,
                 int most = 0);  // 0: any number

  void text(const OptionText& text, std::string& value);
  void text(const OptionText& text, std::optional<std::string>& value);
  /// An option that may be repeated.
  void texts(const OptionText& text, std::vector<std::string>& values);
  /// An option that takes all words up to the next option.
  void list(const OptionText& text, std::vector<std::string>& values);
  void number(const OptionText& text, std::optional<double>& value,
              const Range& range = any());
  void integer(const OptionText& text, std::optional<long>& value,
               const IntegerRange& range = {});
  /// An option that takes all numbers up to the next option.
  void integers(const OptionText& text, std::vector<long>& values,
                const IntegerRange& range = {});
  /// One of the words `allowed`; choices() reads several between commas.
  void choice(const OptionText& text, std::string& value,
              const std::vector<std::string>& allowed);
  void choices(const OptionText& text, std::vector<std::string>& values,
               const std::vector<std::string>& allowed);
  void flag(const OptionText& text, bool& value);

  /// The files that the last of the above names are of one of these kinds. When
  /// the command refuses its input, a file of another kind is named as what it
  /// is.
  void reads(const ExpectedKinds& expected);

  /// The option `name` cannot be used together with any of `others`.
  void exclude(const std::string& name, const std::vector<std::string>& others);
  void example(const std::string& line, const std::string& what);
  void action(Action action) { action_ = std::move(action); }

 private:
  friend class CommandLine;
  struct Option;
  enum class Count { kNone, kOne, kRepeated, kList };
  using Take = std::function<void(const std::vector<std::string>&)>;

  Option& add(const OptionText& text, Count count, Take take, int most = 0);
  const Option* find(std::string_view name) const;
  void require_all() const;
  void take_all() const;
  int carry_out() const;

  CLI::App* app_;
  HelpOfCommand help_;
  std::string group_;
  std::vector<std::unique_ptr<Option>> options_;
  Action action_;
};

/// The program's commands.
class CommandLine {
 public:
  CommandLine(const std::string& description, std::string version);
  ~CommandLine();

  /// Adds a command, which stands under the heading `group` of the overview.
  Command& add(const std::string& name, const std::string& group,
               const std::string& summary);

  /// Returns what the words of the command line ask for: the action of a
  /// command, or one that prints help or the version. Throws
  /// std::invalid_argument for words that are no command line.
  Action parse(const std::vector<std::string>& words);

  bool quiet() const { return quiet_; }

 private:
  struct Words;  // what a first look at the words finds

  Command& command(const std::string& name) const;
  std::string overview() const;
  Action help(const std::vector<std::string>& words) const;
  Words look_at(const std::vector<std::string>& words) const;
  const Command::Option* find_option(std::string_view name,
                                     const Command* command) const;
  std::size_t look_at_option(const std::vector<std::string>& words,
                             std::size_t at, Words& found) const;
  void split(const Command& command, std::vector<std::string> words);
  [[noreturn]] void fail_option(const std::string& name,
                                const Command* command) const;

  std::string description_, version_;
  std::unique_ptr<CLI::App> app_;
  std::unique_ptr<Command> common_;  // options of every command
  std::vector<std::unique_ptr<Command>> commands_;
  bool quiet_ = false, asks_help_ = false, asks_version_ = false;
};

}  // namespace beamgyro::internal
