// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/overrides.h"
#include "config/range.h"
#include "config/table.h"

namespace beamgyro::internal {

struct NumberRead;

/// A TOML file with the overrides of its command applied. It is read through
/// root(). When everything has been read, reject_unknown_keys() finds keys that
/// nobody asked for.
class ConfigDocument {
 public:
  /// Reads a file. Throws std::invalid_argument for a missing file, and with
  /// line and column for text that is not TOML or not UTF-8.
  static ConfigDocument read(const std::filesystem::path& file,
                             const Overrides& overrides = {});
  /// The same for a text in memory, called `name` in messages.
  static ConfigDocument parse(std::string_view text, const std::string& name,
                              const Overrides& overrides = {});

  /// Returns the same text with other overrides, with no key read yet. It is
  /// called `name` in messages unless `name` is empty.
  ConfigDocument with(const Overrides& overrides,
                      const std::string& name = "") const;

  /// Returns the same with its overrides as a part of the file, with no key
  /// read yet. Its text stays that of the file.
  ConfigDocument settled() const;

  /// Returns the value of a dotted key, or null. This does not count as reading
  /// the key.
  const ConfigNode* value(std::string_view dotted_key) const;

  /// Adds every number that is read from now on, with its range, to `numbers`,
  /// which must live as long as the document is read. A null pointer ends this.
  void collect_numbers(std::vector<NumberRead>* numbers) const;

  const ConfigTable& root() const { return root_; }
  const std::string& text() const;  // byte for byte as read
  const std::filesystem::path& path() const;

  /// Throws std::invalid_argument for the first key (in file order) that was
  /// not read, with a suggestion among the keys that were asked for. Keys that
  /// an override added for another document do not count.
  void reject_unknown_keys() const;

 private:
  explicit ConfigDocument(std::shared_ptr<DocumentState> state);
  std::shared_ptr<DocumentState> state_;
  ConfigTable root_;
};

}  // namespace beamgyro::internal
