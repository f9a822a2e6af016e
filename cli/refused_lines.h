// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace beamgyro::internal {

/// What can be wrong with a line of standard input that stands for a sample.
enum class LineFault {
  kCells,   // more or fewer than names
  kNumber,  // a cell that is none, or none of its column
  kValue,   // not finite or out of range
  kTime,    // does not rise
  kTooLong,
  kCutOff,
  kCount  // no fault: how many there are
};

/// A line that is no sample.
class BadLine : public std::invalid_argument {
 public:
  BadLine(LineFault fault, const std::string& words)
      : std::invalid_argument(words), fault_(fault) {}
  LineFault fault() const { return fault_; }

 private:
  LineFault fault_;
};

/// Counts the lines of a stream, and those that are answered nan because they
/// are no samples.
class RefusedLines {
 public:
  void add() { ++lines_; }

  /// Warns of the first one of each kind.
  void add(const BadLine& bad);

  /// Warns of how many there were, if there were any.
  void print_summary() const;

 private:
  std::array<std::size_t, static_cast<std::size_t>(LineFault::kCount)>
      counts_{};
  std::size_t lines_ = 0, refused_ = 0;
};

}  // namespace beamgyro::internal
