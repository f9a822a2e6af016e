// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "dataset/log/log_map.h"
#include "dataset/log/log_text.h"

namespace beamgyro::internal {

/// Reads the rows of a log and the numbers in them as the map states. Errors
/// are std::invalid_argument "file:line:column: ...".
class LogNumbers {
 public:
  /// The text and the map must outlive it. Throws as LogText.
  LogNumbers(std::string_view text, const std::filesystem::path& path,
             const LogMap& map);

  LogText& text() { return text_; }
  const LogText& text() const { return text_; }
  const std::string& path() const { return path_; }

  /// Returns the slot of a column. Throws, with the place of the key in the
  /// map, for a column that the log does not have or has twice.
  std::size_t slot(const LogColumn& column);

  /// Returns the number in a cell, or nothing when it is missing. Throws for
  /// text and for a number that is not finite.
  std::optional<double> number_in(std::size_t slot) const;
  /// Returns whether a cell that is no number has no value: it is empty, a
  /// marker, nan or NA. Throws when it has none and the rules do not drop such
  /// rows.
  bool is_absent(std::size_t slot) const;
  /// The same as number_in(). Also throws for a missing number when the rules
  /// do not drop such rows.
  std::optional<double> present(std::size_t slot) const;
  /// Returns the number in a cell if it is an integer of less than 63 bits.
  std::optional<std::int64_t> whole_in(std::size_t slot) const;

  /// Throws "file:line:column: 'cell' what; expected ...".
  [[noreturn]] void fail(std::size_t slot, const std::string& what,
                         const std::string& expected) const;

 private:
  bool is_marker(std::string_view cell) const;
  std::errc parse_number(std::string_view cell, double& number) const;
  [[noreturn]] void fail_missing(std::size_t slot) const;

  LogText text_;
  const LogMap& map_;
  std::string path_;
};

}  // namespace beamgyro::internal
