// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "cli/input_lines.h"
#include "cli/refused_lines.h"
#include "dataset/log/recording_csv.h"

namespace beamgyro::internal {

/// Samples from lines of CSV on standard input, a line of names first.
class SampleLines {
 public:
  /// Returns the sample of a line, or nothing for an empty one and the line of
  /// names. Throws std::invalid_argument "standard input:line: ..." for names
  /// that cannot be those of samples, and BadLine.
  std::optional<Recording> sample(InputLine line);

 private:
  void take_names(const InputLine& line);
  void require_names() const;
  void require_whole(const InputLine& line) const;
  Recording parsed(const std::string& text) const;
  std::string place() const;

  std::string header_;
  bool has_status_ = false;
  std::ptrdiff_t commas_ = 0;  // of the line of names
  std::size_t number_ = 0;     // of the line, from 1
  double time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace beamgyro::internal
