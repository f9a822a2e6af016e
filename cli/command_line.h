// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/file_kind.h"
#include "cli/help_text.h"
#include "cli/option_values.h"
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

  // Values are texts, paths and numbers of any type; that of an option which
  // may be left out can be optional.

  /// One word; that of an argument, or of an option.
  template <class Text>
  void text(const OptionText& text, Text& value) {
    add(text, Count::kOne,
        [&value, text](const Words& words) { value = text.named(words[0]); });
  }
  /// An option that may be repeated.
  template <class Text>
  void texts(const OptionText& text, std::vector<Text>& values) {
    add(text, Count::kRepeated, [&values](const Words& words) {
      values.assign(words.begin(), words.end());
    });
  }
  /// An option that takes all words up to the next option, or an argument of
  /// one to `most` words; 0: any number.
  template <class Text>
  void list(const OptionText& text, std::vector<Text>& values, int most = 0) {
    add(
        text, Count::kList,
        [&values, text](const Words& words) {
          if (!text.is_option())
            for (const std::string& word : words) text.named(word);
          values.assign(words.begin(), words.end());
        },
        most);
  }
  template <class Number>
  void number(const OptionText& text, Number& value,
              const Range& range = any()) {
    add(text, Count::kOne, [&value, range, text](const Words& words) {
      value = decimal_number(text.long_name(), words[0], range);
    });
  }
  template <class Whole>
  void integer(const OptionText& text, Whole& value,
               const IntegerRange& range = {}) {
    add(text, Count::kOne, [&value, range, text](const Words& words) {
      value = static_cast<typename Bare<Whole>::Type>(
          whole_number(text.long_name(), words[0], range.low, range.high));
    });
  }
  /// A seed of a validation, or the word "random" for one of the system.
  void seed(const OptionText& text, std::optional<std::uint64_t>& value);
  /// An option that takes all numbers up to the next option.
  template <class Whole>
  void integers(const OptionText& text, std::vector<Whole>& values,
                const IntegerRange& range = {}) {
    add(text, Count::kList, [&values, range, text](const Words& words) {
      for (const std::string& word : words)
        values.push_back(static_cast<Whole>(
            whole_number(text.long_name(), word, range.low, range.high)));
    });
  }
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

 private:
  friend class CommandLine;
  struct Option;
  enum class Count { kNone, kOne, kRepeated, kList };
  using Words = std::vector<std::string>;
  using Take = std::function<void(const Words&)>;
  template <class T>
  struct Bare {
    using Type = T;
  };
  template <class T>
  struct Bare<std::optional<T>> {
    using Type = T;
  };

  void add(const OptionText& text, Count count, Take take, int most = 0);
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

  template <class Arguments>
  struct Added {
    Command& command;
    Arguments& arguments;
  };

  /// Adds a command, which stands under the heading `group` of the overview and
  /// calls `run` with its arguments, after these were read.
  template <class Arguments, class Run>
  Added<Arguments> add(const std::string& name, const std::string& group,
                       const std::string& summary, Run run) {
    const auto arguments = std::make_shared<Arguments>();
    Command& command = add(name, group, summary);
    command.action_ = [arguments, run] { return run(*arguments); };
    return {command, *arguments};
  }

  /// Returns what the words of the command line ask for: the action of a
  /// command, or one that prints help or the version. Throws
  /// std::invalid_argument for words that are no command line.
  Action parse(const std::vector<std::string>& words);

  bool quiet() const { return quiet_; }

 private:
  struct Words;  // what a first look at the words finds

  Command& add(const std::string& name, const std::string& group,
               const std::string& summary);
  Command& command(const std::string& name) const;
  std::string overview() const;
  Action help(const std::vector<std::string>& words) const;
  Words look_at(const std::vector<std::string>& words) const;
  const Command::Option* find_option(std::string_view name,
                                     const Command* command) const;
  std::size_t look_at_option(const std::vector<std::string>& words,
                             std::size_t at, Words& found) const;
  std::string run_on_advice(const std::vector<std::string>& words,
                            const Command& command,
                            const std::string& left) const;
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
