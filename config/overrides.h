// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace beamgyro {

struct ConfigNode;
struct OverrideSet;

/// The `--set KEY=VALUE` arguments of one command, shared by its documents:
/// KEY is a dotted path of bare keys, VALUE any TOML value on one line. Every
/// document takes all of them into its own tree; the document that reads a
/// value marks its override as used.
class Overrides {
 public:
  Overrides();
  /// Throws std::invalid_argument for an argument without '=' or key, a value
  /// that is not TOML, a key given twice, and one that a later argument would
  /// replace or that runs through an earlier value which is no table.
  explicit Overrides(const std::vector<std::string>& arguments);

  /// Adds `value` for the key `path` without a look at what is there already.
  /// `place` is what messages blame, `--set KEY=VALUE` when empty.
  void add(const std::vector<std::string>& path, const ConfigNode& value,
           const std::string& place = "");

  /// Throws std::invalid_argument for the first override no document asked
  /// for, with a suggestion among the keys that were asked for.
  void check_all_used() const;

  /// Whether every override was read by some document.
  bool all_used() const;

  /// The dotted keys that documents asked for, sorted.
  std::vector<std::string> keys_asked() const;

  std::string text() const;  // one KEY=VALUE per line, in the order given

 private:
  friend class ConfigDocument;
  std::shared_ptr<OverrideSet> state_;  // documents mark keys as used in it
};

}  // namespace beamgyro
