// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Numbers of a comma-separated file.
struct CsvTable {
  std::filesystem::path path;
  std::vector<std::string> names;            // none when there is no header
  std::vector<std::vector<double>> columns;  // all of the same length, >= 1

  /// Returns the column called `name`. Throws std::invalid_argument that names
  /// the file and lists its columns.
  const std::vector<double>& column(std::string_view name) const;
  /// Returns "file:line" of a row, counted from 0, for messages of the caller.
  std::string place(std::size_t row) const;
};

/// Reads finite numbers separated by commas, with or without a line of names
/// above them. Accepts a UTF-8 byte-order mark, CRLF, blanks around a cell,
/// names in double quotes and empty lines at the end. Throws
/// std::invalid_argument "file:line:column: ..." for anything else.
CsvTable read_csv(const std::filesystem::path& path);

/// The same for a text in memory, called `path` in messages. With `allow_nan` a
/// cell may be nan.
CsvTable parse_csv(std::string_view text, const std::filesystem::path& path,
                   bool allow_nan = false);

/// Returns the names in the first line of a text, none when it holds a number.
/// Throws as parse_csv().
std::vector<std::string> csv_names(std::string_view text,
                                   const std::filesystem::path& path);

}  // namespace beamgyro::internal
