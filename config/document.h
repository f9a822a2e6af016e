// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "config/overrides.h"
#include "config/range.h"
#include "config/table.h"

namespace beamgyro {

/// A TOML file with the overrides of its command taken in. It is read through
/// root(); when everything is read, reject_unknown_keys() finds what is left.
class ConfigDocument {
 public:
  /// Throws std::invalid_argument for a missing file and for text that is not
  /// TOML or not UTF-8, with line and column.
  static ConfigDocument read(const std::filesystem::path& file,
                             Overrides& overrides);
  static ConfigDocument read(const std::filesystem::path& file);
  /// The same for a text already in memory, called `name` in messages.
  static ConfigDocument parse(std::string_view text, const std::string& name,
                              Overrides& overrides);
  static ConfigDocument parse(std::string_view text, const std::string& name);

  /// The same text with other overrides, as if nobody had read it yet; called
  /// `name` in messages unless that is empty.
  ConfigDocument with(Overrides& overrides, const std::string& name = "") const;

  /// The value of a dotted key, or null; does not count as reading it.
  const ConfigNode* value(std::string_view dotted_key) const;

  const ConfigTable& root() const { return root_; }
  const std::string& text() const;  // byte for byte as read
  const std::filesystem::path& path() const;

  /// Throws std::invalid_argument for the first key (in file order) that nobody
  /// read, with a suggestion among those that were asked for. Keys that an
  /// override added for another document do not count.
  void reject_unknown_keys() const;

 private:
  explicit ConfigDocument(std::shared_ptr<DocumentState> state);
  static ConfigDocument parse(std::string text,
                              const std::filesystem::path& path,
                              const std::shared_ptr<OverrideSet>& sets);

  std::shared_ptr<DocumentState> state_;
  ConfigTable root_;
};

}  // namespace beamgyro
