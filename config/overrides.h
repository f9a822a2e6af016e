// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

struct ConfigNode;
struct OverrideSet;

/// Throws OptionError "set KEY=VALUE: message".
[[noreturn]] void reject_override(const std::string& argument,
                                  const std::string& message);

/// Throws OptionError for a text that is not bare keys joined by dots.
void require_override_key(std::string_view key);

/// Returns the key of KEY=VALUE, without the blanks around it.
std::string_view key_of_override(std::string_view text);

/// Returns `first` without those whose keys `later` replaces, then `later`.
std::vector<std::string> merged_overrides(
    std::vector<std::string> first, const std::vector<std::string>& later);

/// The KEY=VALUE arguments of one command, shared by its documents. KEY is a
/// dotted path of bare keys, VALUE any TOML value on one line. Every document
/// puts all of them into its own tree. The document that reads a value marks
/// the override as used.
class Overrides {
 public:
  Overrides();
  /// Throws OptionError for
  /// - an argument without '=' or without a key;
  /// - a value that is not TOML;
  /// - a key that is given twice, or that a later argument would replace;
  /// - a key that lies below an earlier value which is not a table.
  explicit Overrides(const std::vector<std::string>& arguments);

  /// Adds `value` for the key `path` without checking it against the others.
  /// Messages name `place`, or "--set KEY=VALUE" if it is empty, by which files
  /// of sets name the value that a device failed with.
  void add(const std::vector<std::string>& path, const ConfigNode& value,
           const std::string& place = "");

  /// Throws OptionError for the first override that no document asked for,
  /// with a suggestion among the keys that were asked for.
  void check_all_used() const;

  /// Returns whether every override was read by some document.
  bool all_used() const;

  /// Returns the arguments that some other document may depend on: those that
  /// no document has read yet, and those whose value is a table, of which two
  /// documents may read a part each.
  std::vector<std::string> shared_or_unused() const;

  /// Returns the dotted keys that documents asked for, sorted.
  std::vector<std::string> known_keys() const;

  std::string text() const;  // one KEY=VALUE per line, in the order given

 private:
  friend class ConfigDocument;
  std::shared_ptr<OverrideSet> state_;  // documents mark keys as used in it
};

}  // namespace beamgyro::internal
